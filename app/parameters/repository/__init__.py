"""Every query on parameter sets: the production line's questions."""

from app.parameters.repository.sets import COLUMNS, FoundSet, approved, newest, sets, titles

__all__ = ["COLUMNS", "FoundSet", "approved", "newest", "sets", "titles"]
