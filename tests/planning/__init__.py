"""Test plans: programs, scaling to the limits of a rig, files, and what comes back."""
