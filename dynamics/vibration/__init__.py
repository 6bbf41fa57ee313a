"""Motion of the drivetrain: periodic over speed, over a schedule in time, in events; orders of unequal teeth."""
