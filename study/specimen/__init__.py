"""Real bodies: materials, quantities with units and spreads, roughness."""
