"""Rules of a case that span several keys, by topic."""
