"""What the form that starts a fit offers, with the choice that suits the matrix on top."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from app.own_effects.own_effect import OwnEffect
from ident.effects import CATALOGUE
from ident.effects.effect import Effect
from ident.errors import Unusable
from ident.fit.settings import METHODS
from ident.preprocessing import STEPS
from ident.preprocessing.step import Step
from ident.presets import PRESETS, Preset
from ident.presets.suitable_models import in_question
from ident.stages import PLACES
from ident.words.engineering import power_of, with_unit
from ident.words.number import trimmed
from ident.words.titles import symbol
from schemas.matrix import MatrixView


@dataclass(frozen=True)
class ModelChoice:
    """A model, and of each of its parameters: name, symbol, meaning, and the bounds of the literature in words."""

    name: str
    title: str
    parameters: tuple[tuple[str, str, str, str], ...]


@dataclass(frozen=True)
class StartView:
    """The form; `says` what one button does: fit the first model or, where it is to be `chosen`, the one that fits."""

    matrix: str
    says: str
    chosen: bool
    models: tuple[ModelChoice, ...]
    methods: tuple[str, ...]
    effects: tuple[tuple[str, tuple[Effect, ...]], ...]
    force: bool
    steps: tuple[Step, ...]
    runs: tuple[tuple[str, str], ...]


def start_view(matrix: MatrixView, kept: Sequence[OwnEffect] = ()) -> StartView:
    """The form for this matrix; `kept` are the lab's own effects."""
    uses = Counter(run.use for run in matrix.runs)
    models = _in_question(matrix)
    own = tuple(one.effect() for one in kept if any(one.suits(model.name) for model in models))
    others = f"{_counted(uses['verify'])} for validation" if uses["verify"] else "no validation runs"
    return StartView(
        matrix=matrix.id,
        says=f"{_proposed(models)}, genetic search, {_counted(uses['fit'])} for estimation, {others}.",
        chosen=len(models) > 1,
        models=tuple(map(_model, (*models, *(known for known in PRESETS.values() if known not in models)))),
        methods=METHODS,
        effects=tuple((name, found) for name, found in (*_by_place(models), ("own effects", own)) if found),
        force=any("force" in run.channels for run in matrix.runs),
        steps=STEPS,
        runs=tuple((run.id, run.use) for run in matrix.runs),
    )


def _counted(runs: int) -> str:
    return "1 run" if runs == 1 else f"{runs} runs"


def _in_question(matrix: MatrixView) -> tuple[Preset, ...]:
    """The models that the channels allow; where they allow none, all there are: a fit of any says what is missing."""
    try:
        return in_question(matrix.runs, matrix.machine, matrix.states_oil)
    except Unusable:
        return tuple(PRESETS.values())


def _by_place(models: Sequence[Preset]) -> Iterator[tuple[str, tuple[Effect, ...]]]:
    """Each place with its effects that one of the models takes."""
    for place in PLACES:
        at_place = (effect for effect in CATALOGUE if effect.place == place)
        yield place, tuple(effect for effect in at_place if any(model.takes(effect) for model in models))


def _proposed(models: Sequence[Preset]) -> str:
    """What one button fits."""
    if len(models) == 1:
        return models[0].title
    return f"The model that fits of {len(models)} that the channels allow, compared on held-out data"


def _model(preset: Preset) -> ModelChoice:
    return ModelChoice(
        preset.name,
        preset.title,
        tuple(
            (
                p.name,
                symbol(p.name, p.symbol),
                p.meaning,
                f"{_bound(p.lower, p.unit)} to {_bound(p.upper, p.unit)}",
            )
            for p in preset.parameters
        ),
    )


def _bound(value: float, unit: str) -> str:
    power = power_of(value)
    return with_unit(trimmed(value / 10.0**power), unit, power)
