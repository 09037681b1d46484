"""Signals of many samples in, few samples to draw out: the extremes of stretches, stored as levels."""
