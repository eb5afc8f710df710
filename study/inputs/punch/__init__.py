"""What a call or a study file says of the punch: its shape, and how it sticks."""
