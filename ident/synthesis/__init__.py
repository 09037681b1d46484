"""A model, values and noise in, a simulated test matrix out."""
