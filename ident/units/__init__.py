"""A number with a unit in, the same in SI out; and back."""
