"""What is measured of this program itself: work and precision, where the thin layer holds, random extreme cases."""
