"""Models in question in, the run that tells them apart out."""
