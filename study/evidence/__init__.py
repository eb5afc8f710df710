"""What we measure about ourselves: trade-off, validity maps, extremes."""
