"""The stresses of contacts on stacks of layers and on graded ones: docs/stress_fields.md, Transfer."""
