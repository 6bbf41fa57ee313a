"""Report, tables and files of results: reads typed results, knows no solver."""
