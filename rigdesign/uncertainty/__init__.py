"""Assumed inputs over their ranges, and what they decide."""
