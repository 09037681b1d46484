"""The fit that a diagnosis recommends: its last model, begun from the refit of that model."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from ident.custom.definition import Definition, together
from ident.diagnosis.discovery.proposal import Errors, Proposal
from ident.diagnosis.parameter_estimate import ParameterEstimate
from ident.diagnosis.result import Diagnosis
from ident.errors import Unusable
from ident.fit.continued import settings_from
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.fit.start import Start
from ident.words.number import count


@dataclass(frozen=True)
class End:
    """The end of a refit in a diagnosis: the effects that its model has beyond the fitted one, with definitions."""

    added: tuple[str, ...]
    parameters: Mapping[str, ParameterEstimate]
    error: Errors
    custom: tuple[Definition, ...] = ()


def settings_after(
    found: FitResult | Diagnosis, effects: Sequence[str] = (), terms: int | None = None, search: bool = False
) -> Settings:
    """The settings of the fit that begins where a fit ended, or the recommended refit of a diagnosis.

    `effects` take another model that the diagnosis refitted, with just these added to the fitted one; `terms` the first
    of the terms that it proposes. With `search` the whole space is searched, too. Raises Unusable.
    """
    if isinstance(found, FitResult):
        if effects or terms is not None:
            raise Unusable(
                "bad-option",
                "a start that is a fit takes neither effects nor terms",
                "start",
                "give a diagnosis, which refitted what it adds, or fit without a start",
            )
        return settings_from(found, search)
    if effects and terms is not None:
        raise Unusable(
            "bad-option", "effects and a number of terms cannot both be given", "start", "give one of the two"
        )
    end = end_with(found, effects) if effects else recommended(found, terms)
    if end is None:
        known = "; ".join(dict.fromkeys(", ".join(one.added) for one in _ends(found) if one.added))
        raise Unusable(
            "no-such-end",
            f"the diagnosis refitted no model with just {', '.join(effects)} added",
            "start",
            f"choose from {known or 'none'}; or fit without a start",
        )
    return settings_of_end(found, end, search)


def recommended(diagnosis: Diagnosis, terms: int | None = None) -> End:
    """The refit that a diagnosis recommends, with its proposed terms or the first `terms` of them (0: none).

    Where no number is given no term is taken that validation data contradict, unless terms behind it correct that, and
    none behind such a term. Without terms it has no effect that is unconfirmed or by chance.

    Raises Unusable where it proposes fewer, or has no refit.
    """
    proposals = diagnosis.proposals or ()
    if terms is not None and not 0 <= terms <= len(proposals):
        raise Unusable(
            "bad-option", f"{count(terms, 'term')} of {len(proposals)}", "terms", f"give 0 to {len(proposals)}"
        )
    taken = _supported(proposals) if terms is None else proposals[:terms]
    if taken:
        return _with_terms(taken)
    ladder = [end for end in _rungs(diagnosis) if not {*end.added} & {*diagnosis.verdict.unsupported}]
    if not ladder:
        raise Unusable(
            "bad-diagnosis",
            "the diagnosis holds no refit",
            "start",
            "give what `servoident diagnose --json FILE` wrote",
        )
    return ladder[-1]


def _supported(proposals: Sequence[Proposal]) -> Sequence[Proposal]:
    """The first proposed terms, as many as validation data do not contradict; none where they prefer the effects that
    the terms stand in place of."""
    last = proposals[-1] if proposals else None
    if last is None or (last.contradicted and last.contradicted.instead_of):
        return ()
    against = (at for at, one in enumerate(proposals) if one.contradicted and not one.corrected_by(last))
    return proposals[: next(against, None)]


def end_of_ladder(diagnosis: Diagnosis) -> tuple[str, ...]:
    """The effects that the last refit of the ladder has beyond the fitted model; () where there was no refit."""
    return max((end.added for end in _rungs(diagnosis)), key=len, default=())


def end_with(diagnosis: Diagnosis, effects: Sequence[str]) -> End | None:
    """The refit of the model with just these effects and terms added to the fitted one; None where there was none."""
    wanted = {*diagnosis.effects, *effects}
    return next((end for end in _ends(diagnosis) if {*diagnosis.effects, *end.added} == wanted), None)


def settings_of_end(diagnosis: Diagnosis, end: End, search: bool = False) -> Settings:
    """The settings of the fit that begins at an end of a diagnosis: over the same runs and windows."""
    before = Settings.from_json(dict(diagnosis.settings)) if diagnosis.settings else Settings(seed=diagnosis.seed)
    values = {name: one.value for name, one in end.parameters.items()}
    start = Start(
        "diagnosis",
        values,
        diagnosis.horizon,
        diagnosis.memory,
        diagnosis.left_out,
        end.error.get("fit"),
        diagnosis.data_hash,
        search=search,
    )
    effects, custom = tuple(dict.fromkeys((*diagnosis.effects, *end.added))), together(before.custom, end.custom)
    return replace(before, model=diagnosis.model, effects=effects, custom=custom, budget=None, start=start)


def _ends(diagnosis: Diagnosis) -> Iterator[End]:
    """Every refit of a diagnosis, the refit with all proposed terms first."""
    proposals = diagnosis.proposals or ()
    yield from (_with_terms(proposals[:terms]) for terms in range(len(proposals), 0, -1))
    yield from _rungs(diagnosis)
    yield from (End((one.effect,), one.parameters, one.error) for one in diagnosis.candidates if one.parameters)


def _rungs(diagnosis: Diagnosis) -> Iterator[End]:
    """The refits of the ladder, the fitted model first."""
    added: tuple[str, ...] = ()
    for rung in diagnosis.ladder:
        added = (*added, rung.added) if rung.added else added
        if rung.parameters:
            yield End(added, rung.parameters, rung.error)


def _with_terms(terms: Sequence[Proposal]) -> End:
    """The model with these terms, one on top of the other, and the effects that they were found with."""
    last = terms[-1]
    custom = tuple(_as_refitted(one.effect, last.parameters) for one in terms)
    return End((*last.beside, *(str(one["name"]) for one in custom)), last.parameters, last.error, custom)


def _as_refitted(own: Mapping[str, Any], parameters: Mapping[str, ParameterEstimate]) -> dict[str, Any]:
    """The definition of a term with the fitted values of its shapes and its curve: a fit holds these values."""

    def value(symbol: str, otherwise: Any) -> Any:
        known = parameters.get(f"{own['name']}.{symbol}")
        return otherwise if known is None else known.value

    found = dict(own)
    if "shape" in own:
        found["shape"] = {symbol: {**of, "value": value(symbol, of["value"])} for symbol, of in own["shape"].items()}
    if "curve" in own:
        curve = own["curve"]
        values = [value(f"{curve['symbol']}_{n}", known) for n, known in enumerate(curve["values"], 1)]
        found["curve"] = {**curve, "values": values}
    return found
