"""Profile likelihoods of fits whose refits take longer than an answer may: jobs, and what they found."""
