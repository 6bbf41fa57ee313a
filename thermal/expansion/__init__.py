"""Thermal expansion of a gearbox: displacement, deformed geometry, clearances."""
