"""Where and how large stresses are at most (docs/stresses.md), and whether elastic asperities would yield."""
