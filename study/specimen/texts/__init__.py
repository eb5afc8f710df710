"""The lines of a text of a scan: their fields, and rows of numbers that numpy reads."""
