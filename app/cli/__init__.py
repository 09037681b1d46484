"""The command line: a command, or a group of commands, a file; every heavy import inside the command that needs it."""

from app.cli.program import main

__all__ = ["main"]
