"""What the commands show in a terminal: progress on stderr, results on stdout."""
