"""The punch in calls and study files: its shape, its asperities and its adhesion."""
