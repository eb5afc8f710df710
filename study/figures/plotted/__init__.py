"""Figures of `plot` other than curves: fits, bars of the inputs, and maps."""
