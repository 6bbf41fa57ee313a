"""Data checks: what readings and signals say about themselves."""
