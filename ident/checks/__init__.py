"""A measured matrix in, every doubt about it out: a kind a file, and :mod:`ident.checks.check` runs them all."""
