"""What sensors on the rig would read: the models of a check at single operating points."""
