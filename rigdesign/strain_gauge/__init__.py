"""Strain gauges in the tooth root, both ways: from stress to what the logger records, and back."""
