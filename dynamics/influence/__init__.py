"""Influence numbers of gear teeth: deflection and root stress under unit loads on the flank, by finite elements."""
