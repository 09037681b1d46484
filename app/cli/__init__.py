"""The command line: one command a file, every heavy import inside the command that needs it."""

from app.cli.program import main

__all__ = ["main"]
