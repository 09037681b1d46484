"""A test matrix and settings in, identified parameters out: search, optimum, uncertainty, result."""
