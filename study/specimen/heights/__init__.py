"""What is done to the heights of a scan, what is doubted of them, and the asperities that come out."""
