"""Stages and effects in, one model out: a set of equations, and its linearisation."""
