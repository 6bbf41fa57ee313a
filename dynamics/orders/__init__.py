"""Orders of torque and angle from deviations of single teeth."""
