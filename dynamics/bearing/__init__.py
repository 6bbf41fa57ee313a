"""Bearings behind one protocol; the journal bearing: film, temperature, drag torque."""
