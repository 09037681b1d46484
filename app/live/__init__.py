"""Streams that are watched while a test runs: what they show, marks, and recordings that become runs."""
