"""A chain, values and runs in, outputs out."""
