"""What a fitted model lacks: candidates predicted, refitted, and judged on data that no fit saw."""
