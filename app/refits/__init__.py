"""Fits that begin with a request: a search, or where an earlier fit or a diagnosis ended."""
