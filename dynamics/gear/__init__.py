"""Cylindrical gears and gear pairs: geometry, limits, tooth outline, modifications and deviations of the flanks."""
