"""Fits that are deleted, with all that was made of them."""
