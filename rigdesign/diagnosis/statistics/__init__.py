"""Covariances, evidence and intervals, on numbers alone."""
