"""A loop in, its judgement out: stable or not, its mode, the part that makes it grow, and what would stabilise it."""
