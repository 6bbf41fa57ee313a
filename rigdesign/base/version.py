"""Version of the tool and of its results."""

__version__ = "0.1.0"
RESULTS_SCHEMA_VERSION = "3"
"""Of results.json; another one cannot be read as this one."""
