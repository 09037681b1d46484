"""The tests, laid out like the source. `python3 -m tests` runs them all."""
