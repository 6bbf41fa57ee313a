"""Records in SI -> the rows of results.json, in their units."""
