"""A number in, the words for it out."""
