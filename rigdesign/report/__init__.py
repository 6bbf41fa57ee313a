"""Writers of results.json, junit.xml, fields, curves and the self-contained report."""
