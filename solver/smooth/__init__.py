"""Smooth contacts of any shape on any kernel, with and without adhesion, by an integral equation of the second kind."""
