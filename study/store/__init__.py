"""The progress of a study is on disk: blocks, found by the keys of their cases. A results file is an export of them."""
