"""What lies under the punch: springs (the thin layer) and the exact layered half-space."""
