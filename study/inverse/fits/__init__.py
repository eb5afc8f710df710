"""The steps of `fit`: question, starts, least squares, residuals, intervals, dataset."""
