"""The micro law of a scan itself, without a model of asperities: docs/roughness.md."""
