"""From a fitted model and its runs to the missing effects: predicted, refitted, judged on held-out data."""
