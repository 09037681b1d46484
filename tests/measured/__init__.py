"""Measured machines, as a new user would try them: no model named, no bound set by hand."""
