"""Webhooks: other systems are told what has happened, signed, and again until they have heard it."""
