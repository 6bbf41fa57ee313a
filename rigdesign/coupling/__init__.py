"""The coupling loop at one operating point: loads, losses, oil, temperatures, expansion."""
