"""Every kind of doubt about a measured matrix, a file each; :mod:`ident.checks.check` runs them all."""
