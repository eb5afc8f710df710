"""What is on disk is the progress: blocks, keys of cases, earlier results."""
