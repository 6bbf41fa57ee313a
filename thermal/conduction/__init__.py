"""Steady heat conduction: equations, Newton's method, balance."""
