"""What a call or a study file says of the punch: its shape, its asperities, and how it sticks."""
