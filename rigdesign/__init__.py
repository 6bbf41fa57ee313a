"""Coupled thermal-dynamic design checker for back-to-back gear test rigs."""
