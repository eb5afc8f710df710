"""Tables that fits read in place of contacts: a lattice of tiles, tables on it, the branch of contacts that adhere."""
