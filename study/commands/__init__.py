"""What the command line reads and says."""
