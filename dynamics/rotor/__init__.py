"""Shafts, bearings, joints as a graph and as matrices: torsion or six degrees of freedom, power loop, modes."""
