"""The models that a diagnosis leaves in question, read from its JSON."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from ident.custom.definition import read_effect
from ident.effects import EFFECTS
from ident.effects.effect import Effect
from ident.errors import Unusable
from ident.matrix import Matrix
from ident.presets import PRESETS, Preset
from ident.presets import preset as preset_called

Model = tuple[Preset, dict[str, float]]
MOST = 3
NOISE = 0.005
"""The relative noise floor that stands where a diagnosis could not tell it."""


def rivals(diagnosis: Mapping[str, Any], custom: Sequence[Effect] = ()) -> list[Model]:
    """Presets and their values by the equations' names: what the verdict cannot tell apart, else what it settled on.

    Where it settled on nothing, and something is left, it is the best candidates. `custom` are effects of one's own
    that its settings do not define. Raises Unusable for JSON of another form.
    """
    model = diagnosis.get("model")
    if model in PRESETS and PRESETS[model].kind == "bench":
        raise Unusable("no-experiment", "no run is proposed for the records of a bench", f"model {model}",
                       "repeat the records on which the effects differ")  # fmt: skip
    try:
        found = _chosen(diagnosis)
        return [_model(diagnosis, parameters, custom) for parameters in found]
    except (AttributeError, KeyError, TypeError, IndexError) as error:
        raise _bad(f"its {error} cannot be read") from None


def floor_of(diagnosis: Mapping[str, Any]) -> float:
    """The relative noise floor of the fit runs."""
    floor = diagnosis.get("noise_floor")
    found = floor.get("fit") if isinstance(floor, Mapping) else floor
    return float(found) if isinstance(found, int | float) and 0 < found < math.inf else NOISE


def trusted(diagnosis: Mapping[str, Any], matrix: Matrix) -> Matrix:
    """The matrix without the runs whose labels are doubted, as far as runs to fit are left."""
    verdict = diagnosis.get("verdict")
    suspects = verdict.get("suspects") if isinstance(verdict, Mapping) else None
    doubted = {str(entry.get("run")) for entry in suspects or () if isinstance(entry, Mapping)}
    rest = replace(matrix, runs=tuple(run for run in matrix.runs if run.id not in doubted))
    return rest if rest.of_use("fit") else matrix


def _chosen(diagnosis: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    refitted = {entry["effect"]: entry["parameters"] for entry in diagnosis["candidates"] if entry["parameters"]}
    groups: Sequence[Sequence[str]] = diagnosis["verdict"].get("indistinguishable", ())
    for group in groups:
        known = [refitted[name] for name in group if name in refitted]
        if len(known) > 1:
            return known[:MOST]
    ladder = [rung["parameters"] for rung in diagnosis.get("ladder", ()) if rung["parameters"]]
    verdict = diagnosis["verdict"]
    settled = bool(verdict.get("effects")) or not verdict.get("unexplained", True)
    if settled and ladder:  # nothing is in question but how well the parameters are known
        return ladder[-1:]
    return list(refitted.values())[:MOST] or ladder[-1:]


def _model(diagnosis: Mapping[str, Any], parameters: Mapping[str, Any], custom: Sequence[Effect]) -> Model:
    settings = diagnosis.get("settings") or {}
    name = str(diagnosis.get("model") or settings.get("model") or "qian2014")
    definitions = [*(settings.get("custom") or ()), *(diagnosis.get("custom") or ())]
    own = {effect.name: effect for effect in (*custom, *(read_effect(entry, model=name) for entry in definitions))}
    known = [*(effect.name for effect in EFFECTS), *own]
    effects = tuple(e for e in known if any(parameter.startswith(f"{e}.") for parameter in parameters))
    preset = preset_called(name, effects, tuple(effect for effect in own.values() if effect.name in effects))
    values = {preset.parameter(key).in_equations: float(entry["value"]) for key, entry in parameters.items()}
    missing = [parameter.name for parameter in preset.parameters if parameter.in_equations not in values]
    if missing or not all(map(math.isfinite, values.values())):
        raise _bad(f"no value of {missing[0]}" if missing else "a value is not finite")
    return preset, values


def _bad(what: str) -> Unusable:
    return Unusable("bad-diagnosis", f"not the JSON of a diagnosis: {what}", "diagnosis",
                    "give the file that `servoident diagnose --json FILE` wrote")  # fmt: skip
