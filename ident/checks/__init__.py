"""Every kind of doubt about a measured matrix, a file each; :mod:`ident.check` runs them all."""
