"""Figures of what the service has stored."""
