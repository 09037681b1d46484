"""A fit beside its data: what figures and sizes of errors are computed from."""

from __future__ import annotations

from app.context import Context
from app.fits import service
from app.lru import LRU
from app.matrices import service as matrices
from ident import workflows
from ident.figures import Study

_MOST = 2  # fits in memory with what was computed of them
_studies: LRU[Study] = LRU(_MOST)


def study(context: Context, fit_id: str) -> Study:
    """A fit beside its data, from memory where it was drawn lately; raises Failure 404."""

    def made() -> Study:
        stored = service.stored(context, fit_id)
        return workflows.study(matrices.load(context, stored.matrix), stored.found)

    return _studies.get((str(context.storage.folder), fit_id), made)
