"""A case with changed inputs: parameter studies, assumed ranges, what would turn a verdict, two results compared."""
