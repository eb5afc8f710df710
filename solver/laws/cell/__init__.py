"""Asperities that feel the coated body: the periodic cell of one spot on any body with a kernel
(docs/coated_body.md)."""
