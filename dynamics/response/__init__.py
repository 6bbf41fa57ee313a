"""Motion of the drivetrain: over a schedule in time, periodic over speed."""
