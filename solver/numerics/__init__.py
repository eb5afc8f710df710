"""Nodes, quadrature, linear systems, brackets and the ladder of meshes: nothing about contact."""
