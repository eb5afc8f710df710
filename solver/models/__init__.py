"""Cases by the name of their base; how far a cheap model is from the exact one; the base "auto", chosen by that."""
