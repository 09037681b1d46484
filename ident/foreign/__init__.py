"""A file that a parser from elsewhere reads in, its columns out.

:mod:`ident.readers.sandboxed_parser` starts the process that does it. A file here is a format: its ``columns(path)``
gives every column as (name, unit, values). They import nothing of the program, so that the process is there at once;
whatever they raise refuses the file.
"""
