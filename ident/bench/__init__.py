"""Kononykhin's bench: procedures and fitters from the records of an acceptance test to a model of an actuator."""
