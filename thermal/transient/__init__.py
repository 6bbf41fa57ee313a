"""Temperatures over time."""
