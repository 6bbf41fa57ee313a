"""Parametric gearbox or mesh file -> mesh with named surfaces, bodies and stations."""
