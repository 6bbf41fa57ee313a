"""What a run finds and returns: immutable records in SI, and the rows of results.json made of them (`rows`)."""
