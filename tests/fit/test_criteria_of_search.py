"""Each number of the searches decides a case that lies within a third of it."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.errors import Unusable
from ident.fit import genetic, identification
from ident.fit.evolution import cma_es, differential_evolution
from ident.fit.genetic import around, begin, default_step
from ident.fit.identification import Identification
from ident.fit.local_optima import distinct
from ident.fit.search import Search, options_of
from ident.fit.settings import Settings
from ident.fit.trial_runs import decimated, trial_runs
from ident.matrix import Actuator, Matrix
from ident.presets import PRESETS
from ident.run import Run

QIAN = PRESETS["qian2014"]
FREE, NEARBY = Settings(), Settings(load="force")
AXES = 20


class Known(Exception):
    """What a test asks for is known."""


def rough(points: np.ndarray) -> np.ndarray:
    """Errors that tell nothing."""
    return np.random.default_rng(int(1e6 * points[0, 0])).uniform(1.0, 2.0, len(points))


def usual(**changed: float) -> dict[str, float]:
    """The options of the program's own search."""
    return {**options_of(FREE, QIAN), **changed}


@pytest.mark.parametrize(("settings", "population", "generations"), [(FREE, 200, 30), (NEARBY, 64, 12)])
def test_a_search_has_so_many_vectors_and_generations(settings, population, generations):
    search = Search(2, "ga", options_of(settings, QIAN), 0, rough, lambda _: None)
    found = search.advance(search.start(), 1000)
    assert [len(entry["errors"]) for entry in found["history"]] == [population] * generations


@pytest.mark.parametrize(("settings", "elite"), [(FREE, 10), (NEARBY, 6)])
def test_the_best_vectors_of_a_generation_stay(settings, elite):
    options = options_of(settings, QIAN)
    state = begin(AXES, 0, options)
    later = default_step(state, rough, options)
    assert sum(vector in later["population"] for vector in state["population"]) == elite


def mutated(generation: int) -> np.ndarray:
    """The changes of the elements that a generation of equal vectors mutates, of all others zero."""
    options = usual()
    state = begin(AXES, 0, options) | {
        "population": np.full((200, AXES), 0.5).tolist(),
        "history": [{"errors": [0.0] * 200}] * generation,
    }
    return np.array(default_step(state, rough, options)["population"])[10:] - 0.5


def test_three_elements_of_ten_are_mutated_by_a_fifth_of_an_axis_at_first():
    changes = mutated(0)
    assert np.mean(changes != 0) == pytest.approx(0.3, rel=0.1)
    assert np.std(changes[changes != 0]) == pytest.approx(0.2, rel=0.1)


def test_the_last_mutations_have_a_fiftieth_of_the_width_of_the_first():
    changes = mutated(28)  # the last but one of thirty, of which the last makes none
    assert np.std(changes[changes != 0]) == pytest.approx(0.2 * 0.02 ** (28 / 29), rel=0.1)


def test_a_child_lies_up_to_a_third_beyond_its_parents():
    options = usual(mutation=0.0)
    state = begin(AXES, 0, options) | {
        "population": np.repeat([[0.4], [0.6]], [100, 100], axis=0).repeat(AXES, 1).tolist()
    }
    children = np.array(default_step(state, rough, options)["population"])
    assert [children.min(), children.max()] == pytest.approx([0.34, 0.66], abs=0.002)


def test_a_search_with_effects_begins_near_the_model_without_them():
    """First the model itself, then the effect alone, weak, middling and strong, then both at random."""
    of_effects = np.arange(AXES) == 0
    drawn = np.array(around(begin(AXES, 0, usual()), np.full(AXES, 0.5), of_effects)["population"])
    assert np.abs(drawn[1:7, 0] - 0.5) == pytest.approx([0.03, 0.03, 0.15, 0.15, 0.5, 0.5], rel=0.1)
    assert drawn[7:, 0].std() == pytest.approx(np.sqrt(1 / 12), rel=0.1)
    assert np.ptp(drawn[7:, 1:]) == pytest.approx(0.1, rel=0.1)


def noise(name: str, samples: int) -> Run:
    """A run of band-limited white noise."""
    rng = np.random.default_rng(0)
    channels = {"command": rng.standard_normal(samples), "displacement": rng.standard_normal(samples)}
    return Run(name, "", 1000.0, channels, dict.fromkeys(channels, "m"), gain=5.0, kind="blwn")


def test_a_search_takes_the_beginnings_of_long_records_of_noise(monkeypatch):
    """65 536 samples of all runs, 512 of one at least."""
    lengths: list[int] = []

    def known(runs: tuple[Run, ...], band: float, samples: int) -> Any:
        lengths.extend(run.length for run in trial_runs(runs, band, samples))
        raise Known

    monkeypatch.setattr(identification, "trial_runs", known)
    runs = (noise("long", 120_000), noise("short", 600))
    with pytest.raises(Known):
        Identification(Matrix(Actuator("A", piston_area=1e-3), runs), Settings(effects=("dead_zone",)))
    assert lengths[0] == pytest.approx(65_536, rel=0.02)
    assert lengths[1] == 512


@pytest.mark.parametrize(
    ("samples", "period", "every"),
    [(8192, 160.0, 1), (8193, 160.0, 2), (30_000, 160.0, 4), (200_000, 160.0, 5), (200_000, 63.9, 1)],
)
def test_finely_sampled_records_are_decimated_for_a_search(samples, period, every):
    """To 8192 samples of all runs where 32 remain of a period of the band's edge."""
    rate = 1000.0
    run = replace(noise("long", samples), kind="other")
    found = decimated((run, run), 2.0 * np.pi * rate / period)
    two = decimated((run,), 2.0 * np.pi * rate / period)
    assert [one.every for one in two] == [every]
    assert {one.length for one in two} == {-(-samples // every)}
    assert {one.every for one in found} == {min(-(-2 * samples // 8192), max(1, int(period / 32)))}


def test_a_short_run_keeps_the_samples_of_the_shortest_part():
    """512 of each: a run of few samples beside a long one is not left with a handful."""
    long, short = replace(noise("long", 200_000), kind="other"), replace(noise("short", 1600), kind="other")
    assert [run.every for run in decimated((long, short), 2.0 * np.pi)] == [3, 3]
    assert [run.every for run in decimated((long, replace(noise("few", 100), kind="other")), 2.0 * np.pi)] == [1, 1]


def starts_of(monkeypatch: pytest.MonkeyPatch) -> tuple[int, int]:
    """How many vectors of the last and of the first generation of a search are refined."""
    counts: list[int] = []

    def known(_searched: Any, _objective: Any, starts: Any, _report: Any, further: Any, _count: int) -> Any:
        counts.extend((len(starts), len(further)))
        raise Known

    monkeypatch.setattr(identification, "multistart", known)
    fit: Any = object.__new__(Identification)
    fit.settings, fit.report, fit.search = Settings(), None, SimpleNamespace(options=usual())
    fit.objective = fit.searched = SimpleNamespace(space=SimpleNamespace(axes=[None] * AXES))
    drawn = np.random.default_rng(0).random((200, AXES)).tolist()
    history = [{"population": drawn, "errors": [1.0]}]
    with pytest.raises(Known):
        fit.optimum({"best": drawn[0], "population": drawn, "history": history, "evaluations": 0})
    return counts[0], counts[1]


def test_five_distinct_vectors_of_a_search_are_refined(monkeypatch):
    assert starts_of(monkeypatch)[0] == 5


def test_sixteen_further_vectors_are_refined_where_the_first_do_not_settle_it(monkeypatch):
    assert starts_of(monkeypatch)[1] == 16


@pytest.mark.parametrize(("apart", "count"), [(0.085, 1), (0.115, 2)])
def test_vectors_a_tenth_of_an_axis_apart_are_distinct(apart, count):
    assert len(distinct([np.array([0.5]), np.array([0.5 + apart])], 5)) == count


def test_eight_runs_of_many_are_examined_for_a_controller(monkeypatch):
    examined: list[Any] = []
    monkeypatch.setattr(identification, "closed_loop", examined.append)
    identification._fed_back(QIAN, [SimpleNamespace(closed_loop=None)] * 80)
    assert len(examined) == 8


LIMITS = {
    "ga": {
        "population": (10.0, 100_000.0),
        "generations": (None, 10_000.0),
        "elite": (None, 10_000.0),
        "starts": (None, 1000.0),
    },
    "paper-ga": {"keep": (0.05, 0.99), "survivors": (None, 1000.0)},
}


@pytest.mark.parametrize(
    ("method", "name", "limits"), [(method, *one) for method, of in LIMITS.items() for one in of.items()]
)
def test_an_option_is_chosen_within_its_limits(method, name, limits):
    for limit, inside in zip(limits, (1.15, 0.85), strict=True):
        if limit is not None:
            edge = 1.0 - (1.0 - limit) * (2.0 - inside) if limit > 0.9 and limit < 1.0 else limit * inside
            beyond = 1.0 - (1.0 - limit) * inside if limit > 0.9 and limit < 1.0 else limit * (2.0 - inside)
            assert options_of(Settings(method=method, options={name: edge}), QIAN)[name] == edge
            with pytest.raises(Unusable):
                options_of(Settings(method=method, options={name: beyond}), QIAN)


@pytest.mark.parametrize("search", [differential_evolution, cma_es])
def test_the_searches_of_other_libraries_end_after_150_generations(search):
    """Along a curved valley of ten axes (Rosenbrock 1960), of which neither finds the end by then."""
    generations: list[int] = []

    def valley(points: np.ndarray) -> np.ndarray:
        generations.append(len(points))
        x = 4.0 * points - 2.0
        return 1.0 + (100.0 * (x[:, 1:] - x[:, :-1] ** 2) ** 2 + (1.0 - x[:, :-1]) ** 2).sum(axis=1)

    search(10, 0, valley)
    assert len(generations) == pytest.approx(150, abs=1)


@pytest.mark.parametrize(("search", "vectors"), [(differential_evolution, 120), (cma_es, 40)])
def test_the_searches_of_other_libraries_have_so_many_vectors(search, vectors):
    def known(points: np.ndarray) -> np.ndarray:
        raise Known(len(points))

    with pytest.raises(Known) as found:
        search(2, 0, known)
    assert found.value.args == (vectors,)


@pytest.mark.parametrize(("deviation", "generations"), [(0.85e-4, 2), (1.15e-4, 151)])
def test_differential_evolution_ends_where_the_errors_of_a_generation_are_one(deviation, generations):
    """Errors of every generation are 1 and this to either side."""
    pattern = np.where(np.arange(120) % 2, 1.0 + deviation, 1.0 - deviation)
    assert len(differential_evolution(2, 0, lambda points: pattern[: len(points)])) == generations


@pytest.mark.parametrize(("change", "ends"), [(0.85e-7, True), (1.15e-7, False)])
def test_cma_es_ends_where_the_errors_change_by_a_ten_millionth(change, ends):
    """The errors of each generation lie within this; the best of them are never quite the same."""
    generations: list[int] = []

    def scattered(points: np.ndarray) -> np.ndarray:
        generations.append(0)
        return 1.0 + 1e-11 * (len(generations) % 3) + change * np.linspace(0.0, 1.0, len(points))

    cma_es(2, 0, scattered)
    assert (len(generations) < 20) is ends


def test_the_first_generation_of_cma_es_has_a_deviation_of_a_quarter():
    def known(points: np.ndarray) -> np.ndarray:
        raise Known(points)

    with pytest.raises(Known) as found:
        cma_es(200, 0, known)
    within = np.quantile(np.abs(found.value.args[0] - 0.5), 0.5)  # half of them, which no bound has touched
    assert within == pytest.approx(0.6745 * 0.25, rel=0.1)


def test_the_options_of_searches_are_those_of_the_criteria():
    assert genetic.RANGES.keys() >= {name for of in LIMITS.values() for name in of}


def test_the_best_vectors_keep_the_errors_by_which_they_were_the_best():
    """They may have been worked out more exactly than those of a later generation, which would lose them."""
    options, asked = usual(), []

    def worse_later(points: np.ndarray) -> np.ndarray:
        asked.append(len(points))
        return rough(points) + 10.0 * (len(asked) - 1)

    first = begin(AXES, 0, options)
    second = first | default_step(first, worse_later, options)
    third = second | default_step(second, worse_later, options)
    best = np.sort(second["history"][0]["errors"])[:10]
    assert asked == [200, 190]
    assert third["history"][1]["errors"][:10] == best.tolist()
    assert third["best"] == second["best"]
