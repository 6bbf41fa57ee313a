"""A diagnosis as it is reported: diagnosis.json and its sentences."""
