"""A lab's own catalogue: effects of its own that were kept under a name, written or proposed by search."""
