"""Bearings behind one protocol: the journal bearing by its film, rolling bearings by their catalogue numbers."""
