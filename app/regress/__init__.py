"""Recheck of the approved actuators: does today's program still find what was approved?"""
