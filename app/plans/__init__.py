"""Test plans for a rig: made by a job, kept, and sent as an archive of command files."""
