"""Parameter studies: a case over a grid of values."""
