"""Arrays with names of their dimensions: xarray's, which is imported when it is first used, and a light one."""
