"""Heat of a rig outside of its gearboxes: motor, drive, transmission gearbox, couplings; and the room that takes it."""
