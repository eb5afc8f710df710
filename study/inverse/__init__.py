"""Asked backwards: which input makes a wanted result, and which contacts are good enough."""
