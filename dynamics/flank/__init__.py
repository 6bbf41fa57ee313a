"""Modifications and deviations of tooth flanks as one field over profile, face width and tooth."""
