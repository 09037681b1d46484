"""Genetic searches: the paper's, in the documented reading, and the program's own default.

Both are a start and a step from one generation to the next. The whole state of a search is plain data that survives
JSON bit for bit, so that a search may be cut anywhere and taken up again.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.fit.criteria import FIT_CRITERIA

Array = NDArray[np.float64]
Errors = Callable[[Array], Array]
State = dict[str, Any]

PAPER = {"population": 200.0, "keep": 0.85, "mutation": 0.2, "over_bounds": 0.0, "survivors": 5.0}
"""Qian et al. 2014, section 2.2, in the reading with which their Figs. 13 and 14 come out as printed: twenty
generations, a mean error that falls to a third, a cloud that contracts. Population, mutation rate and the last five
vectors are the text's. `keep` is not: its 0.5 leaves five of 200 after six generations. `over_bounds` 0 draws a mutated
element between the smallest and the largest of the vectors that survive; from the whole of Table 2 (1), three vectors
of four are drawn anew in each generation, and neither figure comes out."""
RANGES = {**vars(FIT_CRITERIA.search_options), "mutation": (0.0, 1.0), "over_bounds": (0.0, 1.0)}
"""What a user may choose of either search."""
_OF = FIT_CRITERIA.search
DEFAULT = {
    "population": _OF.population,
    "generations": _OF.generations,
    "elite": _OF.elite,
    "mutation": _OF.mutation,
    "starts": 0.0,
}
WITH_EFFECTS = {
    **DEFAULT,
    "population": _OF.population_nearby,
    "generations": _OF.generations_nearby,
    "elite": _OF.elite_nearby,
}


def around(state: State, centre: Array, of_effects: Array) -> State:
    """The state with its population drawn around a model without effects, the strengths over their whole range.

    First comes the centre itself, then each effect alone at a few strengths to either side.
    """
    population = np.array(state["population"])
    near = centre + _OF.nearby * (population - 0.5)
    drawn = np.where(of_effects, population, np.clip(near, 0.0, 1.0))
    alone = [centre]
    for axis in np.flatnonzero(of_effects):
        for level in _OF.strengths:
            for strength in (centre[axis] + level, centre[axis] - level):
                if 0 <= strength <= 1:
                    alone.append(np.where(np.arange(len(centre)) == axis, strength, centre))
    first = np.array(alone)[: len(drawn)]
    drawn[: len(first)] = first
    return state | {"population": drawn.tolist()}


def begin(axes: int, seed: int, options: dict[str, float]) -> State:
    """A population drawn uniformly from the unit cube (Qian et al. 2014, eq. 16)."""
    rng = np.random.default_rng(seed)
    population = rng.random((int(options["population"]), axes))
    return {
        "population": population.tolist(),
        "rng": rng.bit_generator.state,
        "history": [],
        "best": None,
        "evaluations": 0,
        "done": False,
    }


def paper_step(state: State, errors: Errors, options: dict[str, float]) -> State:
    """One generation of the paper's search.

    Sort by fitness and keep the best share; crossover permutes each column (parameter) by itself; mutation redraws a
    share of each column. With five left they are averaged after the selection, before crossover and mutation. See
    :data:`PAPER` for what is the text's and what a reading.
    """
    population, cost, rng = _evaluated(state, errors)
    order = np.argsort(cost, kind="stable")
    keep = max(int(options["survivors"]), int(len(population) * options["keep"]))
    survivors = population[order[:keep]]
    if keep <= options["survivors"]:
        return _next(state, population, cost, survivors, rng, best=survivors.mean(axis=0), done=True)
    children = np.column_stack([rng.permutation(column) for column in survivors.T])
    redrawn = round(options["mutation"] * keep)
    low, high = (0.0, 1.0) if options["over_bounds"] else (survivors.min(axis=0), survivors.max(axis=0))
    lows, highs = np.broadcast_to(low, len(children.T)), np.broadcast_to(high, len(children.T))
    for column, least, most in zip(children.T, lows, highs, strict=True):
        column[rng.choice(keep, redrawn, replace=False)] = rng.uniform(least, most, redrawn)
    return _next(state, population, cost, children, rng, best=survivors[0])


def default_step(state: State, errors: Errors, options: dict[str, float]) -> State:
    """One generation of the default search: elite kept, tournament parents, blend crossover, mutation that narrows."""
    population, cost, rng = _evaluated(state, errors, int(options["elite"]))
    size, axes = population.shape
    order = np.argsort(cost, kind="stable")
    generation, last = len(state["history"]), int(options["generations"]) - 1
    elite = population[order[: int(options["elite"])]]
    if generation >= last:
        return _next(state, population, cost, population[order], rng, best=elite[0], done=True)
    count = size - len(elite)
    draws = rng.integers(0, size, (2, 2, count))
    first, second = draws[:, 0], draws[:, 1]
    parents = population[np.where(cost[first] <= cost[second], first, second)]
    blend = rng.uniform(-_OF.blend, 1.0 + _OF.blend, (count, axes))
    children = parents[0] + blend * (parents[1] - parents[0])
    width = _OF.mutation_width * _OF.narrowing ** (generation / last)
    mutated = rng.random((count, axes)) < options["mutation"]
    children += np.where(mutated, width * rng.standard_normal((count, axes)), 0.0)
    children = np.abs(children)  # reflected at the bounds
    children = np.clip(1.0 - np.abs(1.0 - children), 0.0, 1.0)
    return _next(state, population, cost, np.concatenate([elite, children]), rng, best=elite[0])


def _evaluated(state: State, errors: Errors, elite: int = 0) -> tuple[Array, Array, np.random.Generator]:
    """The population, its costs and the generator. The first vectors are the `elite` of the last generation: their
    costs are known, and may be more exact than those of all others."""
    population = np.array(state["population"])
    rng = np.random.default_rng()
    rng.bit_generator.state = state["rng"]
    known = np.sort([error for last in state["history"][-1:] for error in last["errors"]], kind="stable")[:elite]
    return population, np.concatenate([known, errors(population[len(known) :])]), rng


def _next(
    state: State,
    population: Array,
    cost: Array,
    children: Array,
    rng: np.random.Generator,
    best: Array,
    done: bool = False,
) -> State:
    entry = {"population": population.tolist(), "errors": cost.tolist()}
    return {
        "population": children.tolist(),
        "rng": rng.bit_generator.state,
        "history": [*state["history"], entry],
        "best": best.tolist(),
        "evaluations": state["evaluations"] + len(population),
        "done": done,
    }
