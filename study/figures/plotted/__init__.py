"""What `plot` draws besides curves: fits, bars of the inputs, and maps."""
