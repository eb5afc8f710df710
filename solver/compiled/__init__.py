"""The compiled core, optional: Newton's method in C with vectors, a case in each lane; numpy (:mod:`..contact`) is its
reference, and solves what it does not take."""
