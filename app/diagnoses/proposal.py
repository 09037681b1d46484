"""The run that the lab should add after a diagnosis: in words, and as an archive of its command signal."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path
from tempfile import TemporaryDirectory

from app.context import Context
from app.diagnoses import service
from app.lru import LRU
from app.matrices import service as matrices
from ident.design.experiment import Experiment
from ident.design.proposal import propose
from ident.diagnosis.competing_models import competing_models
from schemas.diagnosis_result import ProposalView

_MOST = 32  # proposals in memory
_proposed: LRU[Experiment] = LRU(_MOST)


def proposal(context: Context, diagnosis: str, seed: int) -> ProposalView:
    """The proposed run, without its samples."""
    found = _experiment(context, diagnosis, seed)
    return ProposalView(**found.to_json(), conditions=found.conditions, run=found.entry())


def archive(context: Context, diagnosis: str, seed: int) -> bytes:
    """command.csv, command.mat and experiment.json as one .zip."""
    found, packed = _experiment(context, diagnosis, seed), io.BytesIO()
    with TemporaryDirectory() as folder, zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as files:
        found.write(Path(folder))
        for path in sorted(Path(folder).iterdir()):
            files.write(path, path.name)
    return packed.getvalue()


def _experiment(context: Context, diagnosis: str, seed: int) -> Experiment:
    """The best further run: computed once, since the words and the archive are mostly wanted one after the other."""

    def made() -> Experiment:
        stored = service.stored(context, diagnosis)
        return propose(competing_models(stored.found), matrices.load(context, stored.matrix), seed)

    return _proposed.get((str(context.storage.folder), diagnosis, seed), made)
