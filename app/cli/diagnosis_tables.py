"""A diagnosis as tables for a reader."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from app.cli.tables import output, table
from ident.words.percent import percent
from ident.words.plus_minus import plus_minus_si

if TYPE_CHECKING:
    from ident.diagnosis.estimate import Found
    from ident.diagnosis.result import Diagnosis, Ranked

USES = {"fit": "fit", "held_out": "held out", "verify": "verify"}
Row = tuple[str, ...]


def show_diagnosis(found: Diagnosis) -> None:
    """Print a diagnosis: errors, ranking, ladder, suspects, verdict."""
    console = output()
    uses = tuple(USES.values())
    console.print(table((_measure(found), *uses), error_rows(found), numbers=uses))
    header = ("effect", "predicted", "held out", "verify", "strength", "group")
    console.print(table(header, ranking_rows(found), numbers=header[1:4]))
    if rest := unconfirmed(found):
        console.print(rest, markup=False)
    steps = ("added", *uses, "floor", "evidence (nats)")
    console.print(table(steps, ladder_rows(found), numbers=steps[1:]))
    if len(found.ladder) > 1:
        console.print("evidence: nats by which the step made the held-out data more likely", markup=False)
    if found.verdict.suspects:
        rows = [(suspect.run, suspect.what, suspect.evidence) for suspect in found.verdict.suspects]
        console.print(table(("suspect run", "label", "evidence"), rows, numbers=()))
    if found.proposals:
        console.print(table(("proposed by search", "what it would mean", "strength", *uses, "nats (bar)", "or"),
                            proposal_rows(found), numbers=(*uses, "nats (bar)")))  # fmt: skip
        console.print("each on top of those before; `servoident fit MATRIX --custom D.json` adds them, "
                      "D.json what --json wrote", markup=False)  # fmt: skip
    for note in found.notes:
        console.print(f"note: {note}", markup=False)
    console.print(found.verdict.text, markup=False)
    if found.proposals:
        from ident.diagnosis.words import proposed_text

        console.print(proposed_text(found.proposals), markup=False)
    console.print(f"seed {found.seed}: {found.seconds:.2f} s")


def proposal_rows(found: Diagnosis) -> Iterator[Row]:
    """One row a term, each on top of the ones before."""
    for one in found.proposals or ():
        errors = (percent(one.error.get(use)) for use in USES)
        meant = one.meaning + (" (a hypothesis: too few runs to confirm it)" if one.hypothesis else "")
        evidence = f"{one.nats:.3g} ({one.bar:.3g})"
        strength_is = plus_minus_si(one.strength, one.std_error, one.unit, digits=4)
        yield one.equation, meant or "–", strength_is, *errors, evidence, ", ".join(one.alike[:3])


def _measure(found: Diagnosis) -> str:
    return "error (eq. 17)" if found.horizon is None else f"error over {found.horizon:.3g} s"


def error_rows(found: Diagnosis) -> Iterator[Row]:
    """The model's error and the noise floor by use, in per cent."""
    yield "model", *(percent(found.baseline.error.get(use)) for use in USES)
    yield "noise floor", *(percent(found.noise_floor.get(use)) for use in USES)


def ranking_rows(found: Diagnosis) -> Iterator[Row]:
    """One row an effect that was refitted, best first."""
    for ranked in found.candidates:
        if not ranked.parameters:
            continue
        errors = (ranked.predicted_error, ranked.error.get("held_out"), ranked.error.get("verify"))
        others = ", ".join(name for name in ranked.group if name != ranked.effect)
        yield ranked.effect, *map(percent, errors), strength(ranked), f"or {others}" if others else ""


def unconfirmed(found: Diagnosis) -> str:
    """The effects that promised too little to be refitted, in a line."""
    rest = [ranked for ranked in found.candidates if not ranked.parameters]
    if not rest:
        return ""
    best = min((ranked.predicted_error for ranked in rest if ranked.predicted_error is not None), default=None)
    return f"not refitted, predicted {percent(best)} at best: {', '.join(ranked.effect for ranked in rest)}"


def strength(ranked: Ranked) -> str:
    """The strength that the refit found with its standard error and unit; a dash where there was no refit."""
    found = of_effect(ranked.parameters, ranked.effect)
    return "–" if found is None else plus_minus_si(found.value, found.std_error, found.unit, digits=4)


def of_effect(parameters: Mapping[str, Found], effect: str) -> Found | None:
    """The first parameter of an effect, which is its strength."""
    return next((entry for name, entry in parameters.items() if name.startswith(f"{effect}.")), None)


def ladder_rows(found: Diagnosis) -> Iterator[Row]:
    """One row a step: what was added, the errors after it, the floor below them, the evidence for it."""
    floor = percent(found.noise_floor.get("fit"))
    for rung in found.ladder:
        evidence = "–" if rung.nats is None else f"{rung.nats:.3g}"
        yield rung.added or "(the fitted model)", *(percent(rung.error.get(use)) for use in USES), floor, evidence
