"""What is done to heights before asperities are counted on them: missing points, form, row jumps."""
