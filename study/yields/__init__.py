"""At which load bodies and asperities first yield, and which layer protects the body."""
