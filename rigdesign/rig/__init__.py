"""From a case to the inputs of the solvers: gear pairs, drivetrain, bearings, housing and its boundary."""
