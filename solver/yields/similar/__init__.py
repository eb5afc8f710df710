"""First yield of smooth contacts on one layer, whose stress over a/R is a number of h/a and the materials alone."""
