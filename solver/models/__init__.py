"""Cases by the name of their base; the error of cheap models against the exact one; and the base "auto", which chooses
a model by that error."""
