"""What is on disk is the progress: blocks, found by the keys of their cases. A results file is an export of them."""
