"""Two checked cases against each other: inputs that changed, results that moved, verdicts that flipped."""
