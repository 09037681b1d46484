"""Everything about a fit in one file: HTML that opens without a network, or PDF."""
