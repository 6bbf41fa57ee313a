"""ISO ratings: dynamic factor, root stress, pitting, scuffing, micropitting."""
