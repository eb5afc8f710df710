"""Files on disk: whole or not there, checked, and the one module that touches netCDF."""
