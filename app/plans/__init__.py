"""Test plans for a rig: made on request, kept, and sent as an archive of command files."""
