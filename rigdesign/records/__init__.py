"""From the solved rig to its result records, one module per section of the report."""
