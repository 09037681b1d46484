"""One search over actuators, data sets and fits."""
