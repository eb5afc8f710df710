"""Results as labelled datasets, units, and what follows from them."""
