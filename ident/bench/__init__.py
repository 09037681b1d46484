"""Records of an acceptance test in, a model of the actuator and its sheet out: the procedures of Kononykhin."""
