"""A comparison in, where the model fails out: by condition, against what moves inside, and how much of it is noise."""
