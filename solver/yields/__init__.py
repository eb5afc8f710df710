"""The largest stresses and their places (docs/stresses.md), and whether elastic asperities would yield."""
