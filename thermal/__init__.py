"""Steady heat conduction and thermal expansion of gearbox housings. SI units in and out."""
