"""The displacements of a hybrid simulation as they are kept: every n-th sample in single precision, compressed.

The command of a shaking table is kept whole. What the figures show ends at 30 Hz; 512 samples a second are plenty, also
near a peak.
"""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import fields, replace
from typing import Any

import numpy as np

from ident.hybrid.case import Case
from ident.hybrid.hybrid_simulation import HybridResult
from ident.hybrid.scores import Scores
from ident.hybrid.shaking_table import Acceleration
from ident.plain import read

RATE, ROWS = 512.0, 131_072
"""Samples a second that are kept where there are more, and rows that are kept at most."""
_KEPT = ("numerical", "measured", "reference")
_COMMAND = "command"
_NONE = np.zeros(0)


def packed(runs: Mapping[str, HybridResult]) -> bytes:
    """The displacements of simulations of one case, by name."""
    first = next(iter(runs.values()))
    every = max(1, int(first.sample_rate // RATE), -(-len(first.reference) // ROWS))
    arrays: dict[str, Any] = {"every": np.array(every), "reference": _thinned(first.reference, every)}
    for number, run in enumerate(runs.values()):
        arrays |= {f"{name}{number}": _thinned(getattr(run, name), every) for name in _KEPT[:2]}
    if first.case.table is not None:
        arrays[_COMMAND] = first.command  # whole: a rig plays it
    held = io.BytesIO()
    np.savez_compressed(held, **arrays)
    return held.getvalue()


def packed_parts(parts: Mapping[str, HybridResult], alone: Mapping[str, HybridResult] | None) -> bytes:
    """The displacements of several actuators: of each as :func:`packed`, also without a controller."""
    held = io.BytesIO()
    arrays: dict[str, Any] = {}
    for number, (name, one) in enumerate(parts.items()):
        runs = {"under": one} | ({"alone": alone[name]} if alone else {})
        arrays[f"part{number}"] = np.frombuffer(packed(runs), dtype=np.uint8)
    np.savez(held, **arrays)
    return held.getvalue()


def of_part(content: bytes, number: int) -> bytes:
    """What :func:`packed` made of one of several actuators."""
    with np.load(io.BytesIO(content), allow_pickle=False) as held:
        return bytes(held[f"part{number}"].tobytes())


def _thinned(signal: Any, every: int) -> Any:
    with np.errstate(over="ignore", invalid="ignore"):  # of what ran away
        return signal[::every].astype(np.float32)


def command_of(content: bytes) -> Any:
    """The command of a shaking table (n,), in m, at every sample; None where none was kept."""
    with np.load(io.BytesIO(content), allow_pickle=False) as held:
        return held[_COMMAND] if _COMMAND in held.files else None


def unpacked(content: bytes, case: Case, results: Mapping[str, Mapping[str, Any]]) -> dict[str, HybridResult]:
    """The simulations again, by name, of what :func:`packed` made and their JSON: displacements alone."""
    with np.load(io.BytesIO(content), allow_pickle=False) as held:
        arrays = {name: held[name].astype(float) for name in held.files}
    thinned = replace(case, sample_rate=case.sample_rate / float(arrays["every"]))
    return {
        name: _result(thinned, result, arrays | {key: arrays[f"{key}{number}"] for key in _KEPT[:2]})
        for number, (name, result) in enumerate(results.items())
    }


def _result(case: Case, result: Mapping[str, Any], arrays: Mapping[str, Any]) -> HybridResult:
    found = result["scores"]
    scores = None if found["delay"] is None else Scores(**{field.name: found[field.name] for field in fields(Scores)})
    return HybridResult(
        case=case,
        controller=result["controller"],
        effects=result["effects"],
        stable=result["stable"],
        scores=scores,
        command_rms=result["command_rms"],
        critical_delay=result["critical_delay"],
        radius=result["largest_pole"],
        ended=result["ended"],
        seconds=result["seconds"],
        ground=_NONE,
        numerical=arrays["numerical"],
        measured=arrays["measured"],
        reference=arrays["reference"],
        command=_NONE,
        force=_NONE,
        notes=tuple(result["notes"]),
        acceleration=read(Acceleration, shaken) if (shaken := result.get("acceleration")) else None,
    )
