"""For users of atomic force microscopes: force curves of instruments, and a model file of nanite. See docs/afm.md."""
