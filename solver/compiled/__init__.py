"""The compiled core, optional: Newton's method in C with vectors, a case in each lane; numpy (:mod:`..rough`) is its
reference, and solves the cases that it does not take."""
