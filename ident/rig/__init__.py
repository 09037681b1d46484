"""Limits of a rig and the motion of a run in, its peaks and the share that they take of each limit out."""
