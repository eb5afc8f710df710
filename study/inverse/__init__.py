"""Inverse questions: inputs from measured curves (fit), and inputs from wanted results (design). See docs/fit.md."""
