"""The rig that a test is driven on: what it allows, and what a run asks of it."""
