"""An identified actuator in, what it is good for out: tracking, control, hybrid simulation, what a change would do."""
