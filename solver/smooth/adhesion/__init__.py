"""Contacts that stick: one law of adhesion a file, and where they are pulled off."""
