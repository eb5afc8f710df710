"""Points of a curve: fewer of them for a search, how far their residuals hang together, and whether they agree."""
