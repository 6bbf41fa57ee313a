"""From solver results to the records of `rigdesign.results`, one module per section of the report."""
