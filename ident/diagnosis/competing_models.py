"""The models that are in question after a diagnosis."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from ident.custom.definition import read_effect
from ident.design.rivals import NOISE, Model, Rivals
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.parameter_estimate import ParameterEstimate
from ident.diagnosis.result import Diagnosis, bad_diagnosis
from ident.effects import CATALOGUE
from ident.effects.effect import Effect, usual_shapes
from ident.errors import Unusable
from ident.presets import PRESETS, preset

Values = Mapping[str, ParameterEstimate]


def competing_models(diagnosis: Diagnosis, custom: Sequence[Effect] = ()) -> Rivals:
    """The models of an indistinguishable group, else the selected model; where no effect was named, the best
    candidates.

    `custom` are users' effects that the diagnosis does not define. Raises Unusable where it is of a bench, or has too
    few values to put its models together.
    """
    if diagnosis.model in PRESETS and PRESETS[diagnosis.model].kind == "bench":
        raise Unusable(
            "no-experiment",
            "no run is proposed for the records of a bench",
            f"model {diagnosis.model}",
            "repeat the records on which the effects differ",
        )
    models = tuple(_model(diagnosis, values, custom) for values in _chosen(diagnosis))
    floor = diagnosis.noise_floor.get("fit") or 0.0
    suspect_runs = frozenset(suspect.run for suspect in diagnosis.verdict.suspects)
    switches = diagnosis.settings.get("preprocessing", {})
    return Rivals(models, floor if 0 < floor < math.inf else NOISE, suspect_runs, switches)


def _chosen(diagnosis: Diagnosis) -> list[Values]:
    """The parameters of each model in question."""
    refitted = {candidate.effect: candidate.parameters for candidate in diagnosis.candidates if candidate.parameters}
    for group in diagnosis.verdict.indistinguishable:
        known = [refitted[name] for name in group if name in refitted]
        if len(known) > 1:
            return known[: CRITERIA.conclusion.competing]
    ladder = [rung.parameters for rung in diagnosis.confirmed_ladder if rung.parameters]
    settled = bool(diagnosis.verdict.effects) or not diagnosis.verdict.unexplained
    if settled and ladder:  # only the accuracy of the parameters is in question
        return ladder[-1:]
    return list(refitted.values())[: CRITERIA.conclusion.competing] or ladder[-1:]


def _model(diagnosis: Diagnosis, parameters: Values, custom: Sequence[Effect]) -> Model:
    """The preset with the effects that the parameters belong to, and their values."""
    defined = (read_effect(entry, model=diagnosis.model) for entry in diagnosis.settings.get("custom") or ())
    own = {effect.name: effect for effect in (*custom, *defined)}
    known = [*(effect.name for effect in CATALOGUE), *own]
    effects = tuple(name for name in known if any(parameter.startswith(f"{name}.") for parameter in parameters))
    model = preset(diagnosis.model, effects, tuple(effect for effect in own.values() if effect.name in effects))
    values = usual_shapes(model.effects)
    values |= {model.parameter(name).in_equations: entry.value for name, entry in parameters.items()}
    missing = [parameter.name for parameter in model.parameters if parameter.in_equations not in values]
    if missing or not all(map(math.isfinite, values.values())):
        raise bad_diagnosis(f"no value of {missing[0]}" if missing else "a value is not finite")
    return model, values
