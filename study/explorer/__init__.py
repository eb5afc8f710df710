"""A page that solves contacts in a browser: one HTML file, opened from disk, without a network."""
