"""What an identified actuator is good for: controllers, hybrid simulations, what-if and tracking."""
