"""Drawing from opened datasets."""
