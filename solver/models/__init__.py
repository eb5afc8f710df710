"""How far a cheap model is from the exact one, and the base "auto", which chooses by that."""
