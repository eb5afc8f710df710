"""Files on disk: complete or absent, checked, locked; and the only module that uses netCDF."""
