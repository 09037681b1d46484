"""An independent judge: the whole model in one flat file, and its own tests."""
