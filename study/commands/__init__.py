"""The command line: a file has the commands of one kind."""
