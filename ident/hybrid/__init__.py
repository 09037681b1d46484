"""A fit in, what it is good for out: tracking, controllers, hybrid simulation, feedforward, and what a change would do."""
