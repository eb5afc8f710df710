"""Tables that fits read in place of contacts: their lattice of tiles, what is tabulated, the branch that sticks."""
