"""Shafts, gears, joints and bearing seats of a rig in six degrees of freedom: matrices, modes and reduced form."""
