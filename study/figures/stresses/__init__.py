"""A picture of the stresses of one contact."""
