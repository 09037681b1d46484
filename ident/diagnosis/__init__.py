"""A fitted model and its runs in, the missing effects out: predicted, refitted, judged on held-out data."""
