"""What the stored sets of a batch or an actuator tell about production."""
