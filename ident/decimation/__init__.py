"""Signals of many samples drawn from few: the extremes of stretches, and stored levels of them."""
