"""Journal bearings: film, temperature, drag."""
