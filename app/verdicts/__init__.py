"""Whether an actuator passes: its set in force against the limits of its model and batch."""
