"""Tests of what belongs to a whole process: they run in one of their own, see tests/test_alone.py."""
