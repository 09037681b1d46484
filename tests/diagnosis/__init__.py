"""What a fitted model lacks."""
