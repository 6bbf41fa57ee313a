"""Film coefficients, oil films and joints: laws with source and range."""
