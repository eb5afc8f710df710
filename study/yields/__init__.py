"""The load at which bodies and asperities first yield, and the layer that protects the body."""
