"""Arrays with named dimensions: those of xarray, which is imported at its first use, and a light kind."""
