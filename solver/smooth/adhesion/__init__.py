"""Contacts with adhesion: one file for each law of adhesion, and the pull-off."""
