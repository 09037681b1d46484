"""Which set is in force for an actuator: who approved it, when, and why."""
