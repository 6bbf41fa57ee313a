"""What is to be explained, and everything that may explain it."""
