"""The optional compiled core: Newton's method in C, with one case in each lane of the processor's vectors. The numpy
code (:mod:`..rough`) is its reference and solves the cases that the core does not take."""
