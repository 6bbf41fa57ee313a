"""Reanalysis: a solved rig with some inputs changed, where only what they touch is solved again."""
