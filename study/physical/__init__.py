"""Physical scenes: from numbers with units to dimensionless parameters, and from results to SI units."""
