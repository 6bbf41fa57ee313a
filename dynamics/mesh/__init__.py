"""The law of a gear mesh: flanks, stiffness, forces, friction, sliding."""
