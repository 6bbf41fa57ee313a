"""Bearings behind one protocol: the journal bearing by its film, rolling bearings by their catalogue numbers.

`protocol` asks a bearing for its steady state and a state for the stiffness and damping a rotor finds (`lateral`).
"""
