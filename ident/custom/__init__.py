"""A user's own definition in, an effect out: checked, named, and off where its strength is zero."""
