"""The one comparison of two fitted models: whether a gain is real, whether it matters, whether it holds everywhere."""
