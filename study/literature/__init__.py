"""Published formulas of smooth contacts on layers, beside the exact value of this program."""
