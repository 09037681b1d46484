"""Runs in, how much of them is noise out."""
