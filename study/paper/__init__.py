"""What only the paper needs: its numbers, its own numerical method, its figures."""
