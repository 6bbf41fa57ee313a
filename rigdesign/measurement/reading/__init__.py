"""Measurement sets on disk: documents, tables, recordings, as readings in SI."""
