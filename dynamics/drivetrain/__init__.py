"""Shafts, joints and meshes as a graph, assembled to matrices; power loop, bracing, modes."""
