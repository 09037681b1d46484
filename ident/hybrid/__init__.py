"""A fit in, what it is good for out: tracking, controllers, hybrid simulation, feedforward, changed machines."""
