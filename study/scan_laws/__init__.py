"""The micro law of a scan itself, without asperities between: docs/roughness.md."""
