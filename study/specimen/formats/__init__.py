"""Formats of scans that are read here, each in a file of its own: SurfaceTopography reads them wrongly, or not all."""
