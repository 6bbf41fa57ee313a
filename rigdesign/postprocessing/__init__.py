"""Solved points -> records in SI (`results`), and the solved rig that holds them."""
