"""What the form that starts a fit offers, with the choice that suits the matrix on top."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from ident.effects import CATALOGUE
from ident.effects.effect import Effect
from ident.fit.settings import METHODS, Settings
from ident.matrix import BENCH
from ident.presets import PRESETS, Preset
from ident.stages import PLACES
from ident.words.engineering import power_of, with_unit
from ident.words.number import trimmed
from ident.words.symbols import symbol
from schemas.matrix import MatrixView


@dataclass(frozen=True)
class ModelChoice:
    """A model, and of each of its parameters: name, symbol, meaning, and the bounds of the literature in words."""

    name: str
    title: str
    parameters: tuple[tuple[str, str, str, str], ...]


@dataclass(frozen=True)
class StartView:
    """The form; the first model is the one proposed, `says` what one button does."""

    matrix: str
    says: str
    models: tuple[ModelChoice, ...]
    methods: tuple[str, ...]
    effects: tuple[tuple[str, tuple[Effect, ...]], ...]
    force: bool
    runs: tuple[tuple[str, str], ...]


def start_view(matrix: MatrixView) -> StartView:
    """The form for this matrix."""
    proposed = _proposed(matrix)
    uses = Counter(run.use for run in matrix.runs)
    others = f"{uses['verify']} verify it" if uses["verify"] else "none is left to verify it"
    return StartView(
        matrix=matrix.id,
        says=f"{PRESETS[proposed].title}, by genetic search: {_counted(uses['fit'])} fit it, {others}.",
        models=tuple(sorted(map(_model, PRESETS.values()), key=lambda model: model.name != proposed)),
        methods=METHODS,
        effects=tuple((place, found) for place in PLACES if (found := tuple(e for e in CATALOGUE if e.place == place))),
        force=any("force" in run.channels for run in matrix.runs),
        runs=tuple((run.id, run.use) for run in matrix.runs),
    )


def _counted(runs: int) -> str:
    return "1 run" if runs == 1 else f"{runs} runs"


def _proposed(matrix: MatrixView) -> str:
    """A bench's records want the bench's model, a measured drive force the drive's."""
    of_bench = any(run.kind in BENCH for run in matrix.runs)
    for model in PRESETS.values():
        driven = model.driven_by != "command" and all(
            model.driven_by in run.channels and run.output in model.chain.outputs for run in matrix.runs
        )
        if (model.kind == "bench") is of_bench and (driven or of_bench):
            return model.name
    return Settings().model


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
