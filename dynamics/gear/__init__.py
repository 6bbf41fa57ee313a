"""Cylindrical gears and gear pairs: geometry, limits, tooth outline."""
