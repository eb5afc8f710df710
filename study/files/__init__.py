"""Files on disk: whole or not there, checked, locked, and the one module that touches netCDF."""
