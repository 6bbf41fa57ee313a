"""Strain gauges in the tooth root: from stress to bridge output, and back from what a logger records."""
