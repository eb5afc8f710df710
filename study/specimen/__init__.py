"""What is known of real bodies: materials, quantities with units and spreads, roughness."""
