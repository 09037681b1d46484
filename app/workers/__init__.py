"""Who works on the queue: each process tells that it lives, and takes back what a silent one had under way."""
