"""Self-contained pages: report, comparison, diagnosis, study."""
