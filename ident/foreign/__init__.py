"""A file that a parser from elsewhere reads in, its columns out.

:mod:`ident.readers.sandboxed_parser` starts the process that does it.
"""
