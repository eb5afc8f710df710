"""The progress of a study on disk: blocks of cases, identified by keys. A results file is an export of the blocks."""
