"""Tables that fits read in place of solving contacts: a lattice of tiles, tables on it, the branch of contacts with
adhesion."""
