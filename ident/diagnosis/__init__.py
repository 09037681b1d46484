"""A fitted model and its runs in, what the model lacks out: predicted, refitted, judged on data that no fit saw."""
