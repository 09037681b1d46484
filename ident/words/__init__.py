"""A number or a name in, the words for it out. Nothing heavy is imported: the command line speaks with these too."""
