"""How the numbers of a rig answer to every effect: computed once, kept on disk."""
