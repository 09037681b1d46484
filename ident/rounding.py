"""How far rounding reaches: the numbers below which a difference is none."""

from __future__ import annotations

TINY = 1e-300
"""A logarithm's or a quotient's argument is kept above it, near the smallest normal number. No answer depends on it."""
EPSILON: float = 1e-12
"""[of a size] Least relative difference that is more than rounding. Why: rounding of a sum of ten thousand terms.
Test: tests/diagnosis/test_criteria_of_estimation.py::test_a_channel_varies_where_it_does_by_more_than_rounding"""
ROUNDING: float = 1e-9
"""[of the largest value] Changes of a record below it are the rounding of its values. Why: a file has nine digits at
most. Test: tests/noise/test_criteria.py::test_a_record_stands_still_where_it_changes_by_a_billionth"""
