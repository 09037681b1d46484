"""Test plans for a rig: a program in, command files inside the limits of the rig out."""
