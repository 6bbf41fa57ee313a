"""Loaded contact of a cylindrical gear pair: forces, pressure and transmission error over a mesh cycle."""
