"""What a run returns: immutable records in SI whose fields say their units; JSON, tables and data frames of them."""
