"""What a case, its keys and its checks are, said without solving anything."""
