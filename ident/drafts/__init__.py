"""Raw files in, a matrix.yaml out: what they state is found, what they do not state is asked, nothing is guessed."""
