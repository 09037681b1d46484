"""Runs and a fit in, measured beside model out."""
