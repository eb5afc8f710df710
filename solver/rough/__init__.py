"""The contact problem: its equation, first guesses, iterations, errors and results."""
