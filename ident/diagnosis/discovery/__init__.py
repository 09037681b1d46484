"""Unlisted terms: terms that may be missing at each place of a chain are searched for and tried."""
