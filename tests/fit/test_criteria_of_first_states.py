"""Each number about how a record begins, and about its blocks, decides a case that lies within a third of it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.fit import continued
from ident.fit.continued import ContinuedIdentification
from ident.fit.initial_state_estimation import BestInitialState, InitialStateEstimation, better
from ident.fit.normal_matrices import NormalMatrices, block_length, normal_matrices_of
from ident.fit.products import shares_of
from ident.fit.simulated_runs import SimulatedRuns
from ident.run import Run
from tests.fit.windows_of import record

START = np.zeros(1)


def found(power: float, promises: bool = False, settled: bool = False, offset: float = 0.0) -> Any:
    """What first states leave of a run; a damped step is as long as its damping."""
    return SimpleNamespace(
        power=power, promises=promises, settled=settled, offset=offset, release="straight", step=lambda damping: damping
    )


def test_first_states_are_followed_for_twenty_rounds_at_most():
    rounds: list[int] = []

    class Restless(SimulatedRuns):
        """Runs whose first states never hold."""

        chain = SimpleNamespace(begun=())

        def together(self, *_: Any, **__: Any) -> Any:
            yield self.runs

        def _normal_matrices(self, *_: Any) -> Any:
            rounds.append(0)
            return [found(1.0)]

        def goes_on(self, *_: Any) -> bool:
            return True

    runs = Restless(None, None, (record("r", np.ones(9)),), 1.0)
    runs.settled({}, np.empty(0), 1)
    assert len(rounds) == 20


def test_a_continued_fit_follows_first_states_three_times(monkeypatch):
    class Fitness(SimpleNamespace):
        """A fitness of simulations."""

    asked: list[int] = []
    fresh: Any = Fitness(
        exact=lambda _: SimpleNamespace(error=1.0), runs=(SimpleNamespace(begins="moving"),), evaluations=0
    )
    fresh.followed = lambda _point, rounds: asked.append(rounds) or fresh
    monkeypatch.setattr(continued, "SimulatedFitness", Fitness)
    monkeypatch.setattr(continued, "_error", lambda *_: 1.0)
    fit: Any = object.__new__(ContinuedIdentification)
    fit.objective = SimpleNamespace(fresh=lambda _: fresh, runs=(), evaluations=0)
    fit._tried(START, refine=False)
    assert asked == [3]


@pytest.mark.parametrize(
    ("explained", "settled", "promises"),
    [(0.85e-6, True, False), (1.15e-6, False, False), (0.085, False, False), (0.115, False, True)],
)
def test_first_states_hold_or_promise_much_by_what_they_explain(explained, settled, promises):
    of: Any = SimpleNamespace(release=START, centred=1.0 - explained, power=1.0)
    assert NormalMatrices.settled.fget(of) is settled
    assert NormalMatrices.promises.fget(of) is promises


def steps(settling: InitialStateEstimation, *powers: float, promises: bool = True) -> list[Any]:
    """Along what a run goes on in rounds that leave these powers; None where it does not."""
    gone_on = (settling.step("r", START, found(power, promises)) for power in powers)
    return [None if one is None else one[1] for one in gone_on]


def test_a_damped_step_begins_with_a_millionth_and_is_damped_a_hundredfold():
    """After straight ones in vain. It is damped a tenth as much after one that helped."""
    settling = InitialStateEstimation()
    *_, last = steps(settling, 1.0, *[2.0] * 4)
    assert last == pytest.approx(1e-6, rel=0.1, abs=0.0)
    assert steps(settling, 2.0, 2.0, 0.5) == pytest.approx([1e-4, 1e-2, 1e-3], rel=0.1)


@pytest.mark.parametrize(("less", "goes_on"), [(0.85e-3, False), (1.15e-3, True)])
def test_a_round_counts_that_explains_a_thousandth(less, goes_on):
    """Where little is promised one round may not count, and the second ends it; of two ends as good one is better."""
    settling = InitialStateEstimation()
    *_, last = steps(settling, 1.0, 1.0, 1.0 - less, promises=False)
    assert (last is not None) is goes_on
    ends = [
        BestInitialState(START, found(1.0, offset=0.5)),
        BestInitialState(START, found(1.0 / (1.0 - less) + less**2, offset=0.1)),
    ]
    assert (better(ends) is ends[0]) is goes_on


@pytest.mark.parametrize(("promises", "rounds"), [(False, 1), (True, 4)])
def test_so_many_rounds_may_be_in_vain(promises, rounds):
    """Then no step follows, or where much is promised a damped one."""
    *gone_on, last = steps(InitialStateEstimation(), *[1.0] * (rounds + 1), promises=promises)
    assert gone_on == ["straight"] * rounds
    assert last != "straight"


def test_a_first_state_is_moved_by_a_thousandth_of_its_size():
    run = record("r", np.tile([-3.0, 3.0], 8))
    chain = SimpleNamespace(begun=["x", "other"])
    of: Any = SimpleNamespace(
        chain=chain,
        runs=(run,),
        preset=SimpleNamespace(core=SimpleNamespace(states=["x"])),
        _of_effects=["other"],
        sizes=np.array([2.0]),
        _sized=lambda: np.zeros(1),
    )
    assert SimulatedRuns._reach.func(of) == pytest.approx([2e-3, 3e-3])


def test_an_effect_begins_with_three_times_what_the_run_gives_it_at_most():
    """A mass that is next to nothing would begin behind a spring stretched without bounds, and move the machine."""
    of: Any = SimpleNamespace(
        chain=SimpleNamespace(begun=["x", "stretch", "unseen"]),
        _of_effects=["stretch", "unseen"],
        _sized=lambda: np.array([2.0, 0.0]),
        starts={},
        _free=lambda _: np.arange(3),
        _reach=np.ones(3),
    )
    of._most = SimulatedRuns._most.fget(of)
    SimulatedRuns._follow(of, record("r", START), np.zeros(3), np.array([9.0, -9.0, 9.0]))
    assert of.starts["r"] == pytest.approx([9.0, -6.0, 9.0])


@pytest.mark.parametrize(("shows", "share"), [(0.85e-11, 0.0), (1.15e-11, 1.0)])
def test_a_first_state_that_shows_by_rounding_alone_has_no_share(shows, share):
    power = np.array([[[shows**2]]])
    assert shares_of(power, power, np.ones(1)).item() == pytest.approx(share)


@pytest.mark.parametrize(("at", "part"), [(15, 1 / 16), (16, 0.0)])
def test_the_first_sixteen_samples_tell_where_a_record_begins(at, part):
    """They count a thousand times all samples: of one stroke among them the square of its part of their mean."""
    measured = np.zeros(64)
    measured[at] = 1.0
    sums = SimulatedRuns._beginning(None, (record("r", measured),), np.zeros((64, 1, 1)), np.zeros((1, 2, 2)))
    assert sums[0, -1, -1] == pytest.approx(1e3 * 64 * part**2)


@pytest.mark.parametrize(("samples", "length"), [(64_000, 2000), (320, 16)])
def test_a_record_has_32_blocks_of_sixteen_samples_and_more(samples, length):
    assert block_length(SimpleNamespace(length=samples)) == length


@pytest.mark.parametrize(("times", "ran_away"), [(0.85e12, False), (1.15e12, True)])
def test_a_model_whose_residual_is_a_million_records_has_run_away(times, ran_away):
    run: Run = record("r", np.tile([-1.0, 1.0], 50))
    gram = np.diag([100.0, times * run.power])
    (of,) = normal_matrices_of([run], gram[None, None], 0)
    assert np.isinf(of.error) == ran_away
