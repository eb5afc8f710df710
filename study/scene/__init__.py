"""The physical scene: materials, roughness, quantities with units."""
