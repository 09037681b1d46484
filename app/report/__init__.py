"""One HTML file that tells everything about a fit, and opens without a network."""
