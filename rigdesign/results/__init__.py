"""What a run returns: immutable records."""
