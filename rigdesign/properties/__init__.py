"""Properties of oils and solid materials."""
