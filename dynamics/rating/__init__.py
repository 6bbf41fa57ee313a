"""ISO ratings, dynamic factor, root stress."""
