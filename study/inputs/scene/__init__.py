"""Inputs with units: their SI values, materials by name, and the dimensionless numbers that follow."""
