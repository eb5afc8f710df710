"""Curves P(D) of contacts that stick: tables over the contact radius, and the branch that is measured."""
