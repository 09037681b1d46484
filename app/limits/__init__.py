"""What the parameters of a model have to keep to, and who does."""
