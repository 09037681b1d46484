"""What need not be kept: shown first, then removed."""
