"""The search of any fit over the unit cube, a block of generations at a time, and what its generations say of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.fit import genetic
from ident.fit.evolution import GENERATIONS, cma_es, differential_evolution
from ident.fit.result import Generation
from ident.fit.settings import Settings
from ident.fit.space import Space
from ident.presets import Preset
from ident.progress import Progress, Report
from ident.unstable import UNSTABLE
from ident.words.nearest import did_you_mean

Array = NDArray[np.float64]
Errors = Callable[[Array], Array]
State = dict[str, Any]
_STEPS = {"ga": genetic.default_step, "paper-ga": genetic.paper_step}


@dataclass(frozen=True)
class Search:
    """One search over `axes` parameters by a method of the settings.

    `errors` gives the cost (v,) of points (v, axes) of the unit cube. The state is plain JSON data; however the search
    is cut into blocks, it ends the same, bit for bit. A method that only works out a solution has no generation.
    """

    axes: int
    method: str
    options: Mapping[str, float]
    seed: int
    errors: Errors
    report: Report

    @property
    def generations(self) -> int:
        """Upper bound of the search's generations."""
        if not self.axes:
            return 0
        if self.method == "paper-ga":
            shrink = self.options["survivors"] / self.options["population"]
            return int(np.ceil(np.log(shrink) / np.log(self.options["keep"]))) + 2
        return int(self.options.get("generations", GENERATIONS.get(self.method, 0)))

    def start(self) -> State:
        """The state before the first generation."""
        options = dict(self.options) if self.method in _STEPS else {"population": 1.0}
        state = genetic.begin(self.axes, self.seed, options)
        return state if self.generations else state | {"done": True, "best": []}

    def advance(self, state: State, generations: int) -> State:
        """The state after at most `generations` more; the library searches run to their end at once."""
        if self.method in GENERATIONS and not state["done"]:
            return self._evolved(state)
        for _ in range(generations):
            if state["done"]:
                break
            state = state | _STEPS[self.method](state, self.errors, dict(self.options))
            self._tell(len(state["history"]), min(state["history"][-1]["errors"]))
        return state

    def _evolved(self, state: State) -> State:
        count = 0

        def errors(points: Array) -> Array:
            nonlocal count
            cost = self.errors(points)
            count += 1
            self._tell(min(count, self.generations), float(cost.min()))
            return cost

        search = differential_evolution if self.method == "differential-evolution" else cma_es
        history = search(self.axes, self.seed, errors)
        entries = [{"population": points.tolist(), "errors": cost.tolist()} for points, cost in history]
        population, cost = min(history, key=lambda entry: float(entry[1].min()))
        order = np.argsort(cost, kind="stable")
        evaluated = sum(len(points) for points, _ in history)
        return state | {
            "population": population[order].tolist(),
            "best": population[order[0]].tolist(),
            "history": entries,
            "evaluations": evaluated,
            "done": True,
        }

    def _tell(self, done: int, best: float) -> None:
        self.report(Progress("search", done, self.generations, best))


def options_of(settings: Settings, preset: Preset) -> dict[str, float]:
    """The method's options, those of the user over the model's over the usual. Raises Unusable for an unknown one."""
    near = bool(preset.effects) or settings.load == "force"  # to what was found without them, or with the specimen
    default = {**(genetic.WITH_EFFECTS if near else genetic.DEFAULT), **preset.search.options}
    known = {"ga": default, "paper-ga": genetic.PAPER}.get(settings.method, {})
    for name, value in settings.options.items():
        if name not in known:
            remedy = did_you_mean(name, known)
            raise Unusable("unknown-option", f"method {settings.method} has no option {name!r}", "options", remedy)
        lower, upper = genetic.RANGES[name]
        if not lower <= value <= upper:
            raise Unusable("bad-option", f"{name} = {value:g}", "options", f"give {lower:g} to {upper:g}")
    return {**known, **settings.options}


def evolution(space: Space, state: Mapping[str, Any]) -> tuple[Generation, ...]:
    """The generations with their populations in SI, to five digits: enough to draw."""
    out = []
    for index, entry in enumerate(state["history"]):
        values = space.values(np.array(entry["population"]))
        columns = [[float(f"{v:.5g}") for v in values[name]] for name in space.names]
        errors = tuple(float(f"{e:.6g}") for e in entry["errors"])
        stable = [error for error in errors if error < UNSTABLE] or [UNSTABLE]
        mean = float(np.mean(stable))
        out.append(Generation(index + 1, min(errors), mean, tuple(zip(*columns, strict=True)), errors))
    return tuple(out)
