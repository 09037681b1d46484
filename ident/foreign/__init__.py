"""A file that a parser from elsewhere reads in, its columns out, in a process that :mod:`ident.readers.apart` starts.

A file here is a format: its ``columns(path)`` gives every column as (name, unit, values). They import nothing of the
program, so that the process is there at once; whatever they raise refuses the file.
"""
