"""A new case from the few numbers that its owner knows, as a file with comments."""
