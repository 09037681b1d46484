"""A diagnosis as tables for a reader: on a terminal and in a notebook."""

from __future__ import annotations

from collections.abc import Iterator

from ident.diagnosis.discovery.term_count_curve import term_count_curve
from ident.diagnosis.result import Diagnosis, Ranked
from ident.diagnosis.summary import summary
from ident.preprocessing.pipeline import outcome_sentences
from ident.words.error import error_said
from ident.words.message import message
from ident.words.percent import percent, probability_said
from ident.words.plus_minus import UNDETERMINED, plus_minus
from ident.words.result_tables import Listing, listings
from ident.words.titles import DATA

Row = tuple[str, ...]


@listings.register
def diagnosis_listings(diagnosis: Diagnosis) -> Iterator[Listing | str]:
    """Errors, ranking, ladder, suspects, proposals; sentences between and below them."""
    uses = tuple(DATA.values())
    yield diagnosis.headline
    if any(value is not None for value in (*diagnosis.baseline.error.values(), *diagnosis.noise_floor.values())):
        yield Listing("", (_measure(diagnosis), *uses), error_rows(diagnosis), uses)
    if ranked := [*ranking_rows(diagnosis)]:
        header = ("effect", "probability", "predicted", "held-out", "validation", "strength", "group")
        yield Listing("", header, ranked, header[1:5])
    if rest := unconfirmed(diagnosis):
        yield rest
    steps = ("added", *uses, "floor", "evidence (nats)")
    if diagnosis.ladder:
        yield Listing("", steps, ladder_rows(diagnosis), steps[1:])
    if len(diagnosis.ladder) > 1:
        yield "evidence: nats by which the step made the held-out data more likely"
    if diagnosis.verdict.suspects:
        rows = [(suspect.run, suspect.what, suspect.evidence) for suspect in diagnosis.verdict.suspects]
        yield Listing("", ("suspect run", "label", "evidence"), rows)
    if diagnosis.proposals:
        yield proposals_listing(diagnosis)
        yield "each on top of those before"
    for note in diagnosis.notes:
        yield f"note: {note}"
    for said in outcome_sentences(diagnosis.preprocessing, diagnosis.notes):
        yield f"preprocessing: {said}"
    yield diagnosis.verdict.text
    yield "\n".join(summary(diagnosis))


def proposals_listing(diagnosis: Diagnosis) -> Listing:
    """The table of the proposed terms."""
    numbers = (*DATA.values(), "nats (bar)")
    header = ("terms", "proposed by search", "what it would mean", "strength", *numbers, "or")
    return Listing("", header, proposal_rows(diagnosis), ("terms", *numbers))


def proposal_rows(diagnosis: Diagnosis) -> Iterator[Row]:
    """The error against the number of terms: none, then one row a term, each on top of the ones before."""
    without, *rest = term_count_curve(diagnosis.proposals or (), diagnosis.ladder)
    errors = [error_said(without.error.get(use)) for use in DATA]
    yield "0", f"(with {without.latest})" if without.latest else "(the fitted model)", "–", "–", *errors, "–", ""
    for choice, one in zip(rest, diagnosis.proposals or (), strict=True):
        errors = [one.error_of(use).said() for use in DATA]
        meant = str(message("term.hypothesis", meaning=one.meaning)) if one.hypothesis else one.meaning
        evidence = f"{one.nats:.3g} ({one.bar:.3g})"
        strength_is = _searched(one.strength, one.std_error, one.unit)
        yield str(choice.terms), one.equation, meant or "–", strength_is, *errors, evidence, ", ".join(one.alike[:3])


def _measure(diagnosis: Diagnosis) -> str:
    return "error (eq. 17)" if diagnosis.horizon is None else f"error over {diagnosis.horizon:.3g} s"


def error_rows(diagnosis: Diagnosis) -> Iterator[Row]:
    """The model's error and the noise floor by use, in per cent."""
    yield "model", *(diagnosis.baseline.error_of(use).said() for use in DATA)
    yield "noise floor", *(percent(diagnosis.noise_floor.get(use)) for use in DATA)


def ranking_rows(diagnosis: Diagnosis) -> Iterator[Row]:
    """One row an effect that was refitted, best first."""
    for ranked in diagnosis.candidates:
        if not ranked.parameters:
            continue
        errors = (error_said(ranked.predicted_error), *(ranked.error_of(use).said() for use in ("held_out", "verify")))
        others = ", ".join(name for name in ranked.group if name != ranked.effect)
        yield (
            ranked.effect,
            probability_said(ranked.probability),
            *errors,
            strength(ranked),
            f"or {others}" if others else "",
        )


def unconfirmed(diagnosis: Diagnosis) -> str:
    """The effects whose prediction was too small for a refit, in a line."""
    rest = [ranked for ranked in diagnosis.candidates if not ranked.parameters]
    if not rest:
        return ""
    best = min((ranked.predicted_error for ranked in rest if ranked.predicted_error is not None), default=None)
    return f"not refitted, predicted {error_said(best)} at best: {', '.join(ranked.effect for ranked in rest)}"


def strength(ranked: Ranked) -> str:
    """The strength that the refit found with its standard error and unit; a dash where there was no refit."""
    found = ranked.strength
    return "–" if found is None else _searched(found.value, found.std_error, found.unit)


def _searched(value: float, std_error: float | None, unit: str) -> str:
    """A strength, which is always searched for: without a standard error the data do not determine it."""
    return UNDETERMINED if std_error is None else plus_minus(value, std_error, unit)


def ladder_rows(diagnosis: Diagnosis) -> Iterator[Row]:
    """One row for each step: the added effect, the errors after it, the floor below them, the evidence for it."""
    floor = percent(diagnosis.noise_floor.get("fit"))
    for rung in diagnosis.ladder:
        evidence = "–" if rung.nats is None else f"{rung.nats:.3g}"
        yield rung.added or "(the fitted model)", *(rung.error_of(use).said() for use in DATA), floor, evidence
