"""Sentences about what a few contacts have alone: shapes, adhesion, asperities that yield."""
