"""From the heights of a scan to asperities: form, row jumps, missing points, low-pass, summits, and doubts."""
