"""The compiled core, optional: Newton's method in C with vectors, a case in each lane; numpy (:mod:`..rough`) is its
reference, and solves what it does not take."""
