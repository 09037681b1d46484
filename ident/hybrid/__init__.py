"""What an identified actuator is good for: tracking, control, hybrid simulation, and what a change would do."""
