"""Where no model is named: the simplest good one at the noise, else the most probable one, each with an effect."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.signal import cont2discrete, lfilter

from ident.diagnosis import structure_selection
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.evidence.comparison import Residuals
from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA
from ident.diagnosis.evidence.energy_bands import EnergyBands, Record
from ident.diagnosis.structure_selection import (
    _judged,
    _preferred,
    _probabilities,
    choose_structure,
    compared_structures,
)
from ident.fit.result import FitResult, Structure, TransducerOffset
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.presets import preset
from ident.presets.suitable_models import unusual
from ident.progress import silent
from ident.run import Run
from ident.workflows import identify
from tests.blind.any_machine import Lab, sound
from tests.blind.various import Various
from tests.fit.test_windows import cylinder
from tests.presets.test_machines import motor, specimen
from tests.short_form import short_form

RATE = 100.0


def lag(output: str, integrates: bool, levels: int = 60) -> Matrix:
    """A lag of 0.1 s, or the integral of what is behind it; solved exactly from sample to sample, noise of 1 %."""
    runs = []
    for number, use in enumerate(("fit", "fit", "verify")):
        rng = np.random.default_rng([3, number])
        u = np.repeat(rng.uniform(-1, 1, levels), 20)
        u -= u.mean() if integrates else 0.0
        y, x, held = np.zeros(len(u)), np.zeros(len(u)), np.exp(-1 / (RATE * 0.1))
        for k in range(1, len(u)):
            y[k] = held * y[k - 1] + (1 - held) * u[k - 1]
            x[k] = x[k - 1] + 0.1 * (1 - held) * (y[k - 1] - u[k - 1]) + u[k - 1] / RATE
        shown = x if integrates else y
        shown = shown + 0.01 * shown.std() * rng.standard_normal(len(u))
        units = {"command": "V", output: "m"}
        runs.append(Run(f"r{number}", "", RATE, {"command": u, output: shown}, units, hold="zoh", use=use))
    return Matrix(Actuator("X"), tuple(runs))


@cache
def compared(integrates: bool) -> tuple[Structure, ...]:
    return compared_structures(lag("displacement", integrates))


@cache
def of_motor() -> tuple[Structure, ...]:
    """Its callers rank few effects. The command is in units of 1: a voltage that turns something opens no valve."""
    matrix = motor(8)
    runs = (replace(run, units={"command": "1", "velocity": "rad/s"}) for run in matrix.runs)
    return compared_structures(replace(matrix, runs=tuple(runs)))


@pytest.mark.parametrize(("ratio", "model"), [(-0.3, "first_order"), (1.0, "position_servo")])
def test_angles_of_both_sides_of_a_gear_are_no_loop(ratio, model):
    """Command and output are angles both. A loop would bring the output to the command; a gear brings it elsewhere."""
    matrix = lag("displacement", integrates=False, levels=20)
    runs = [
        replace(
            run, units={"command": "rad", "displacement": "rad"},
            channels={"command": run.command, "displacement": ratio * run.channels["displacement"]},
        )
        for run in matrix.runs
    ]  # fmt: skip
    choice = choose_structure(replace(matrix, runs=tuple(runs)))
    assert choice.structures[0].machine == model
    assert choice.fit is not None
    assert choice.fit.error["fit"] < 0.03
    assert ("first_order" in {one.machine for one in choice.structures}) is (ratio < 0)


@pytest.mark.parametrize(("integrates", "model"), [(False, "first_order"), (True, "open_valve")])
def test_a_machine_that_settles_is_told_from_one_that_integrates(integrates, model, full):
    """Both were recorded alike, command to position; the one that is taken leaves the noise."""
    if not full:  # one that integrates is compared over one time below, one that settles by its number of parameters
        pytest.skip("a quarter of a minute each: run with --full")
    first, *others = compared(integrates)
    assert first.machine == model
    # The noise, √2 of it over windows that begin where they were measured, with its own noise.
    assert first.error["held_out"] < 0.0115 * np.sqrt(2)
    assert "simplest" in first.why
    on_a_spring = set() if integrates else {"sprung_motor"}
    assert {one.machine for one in (first, *others)} == {"first_order", "motor", "open_valve", *on_a_spring}
    wrong = next(one for one in others if one.machine == ("first_order" if integrates else "motor"))
    assert wrong.error["held_out"] is None or wrong.error["held_out"] > 3 * first.error["held_out"]


def lift(rate: float = 8.0) -> Matrix:
    """A load that follows its reference with 0.6 s upwards and 3 s downwards, read coarsely, begun while it creeps."""
    levels = [0.4, 2, 3.3, 4.6, 6, 7.2, 8.5, 9.5, 8.2, 6.8, 5.5, 4.2, 3, 1.7, 0.4]
    reference = np.repeat(levels, int(8 * rate))
    shown = np.full(len(reference), 0.5)
    for k in range(1, len(shown)):
        behind = shown[k - 1] - reference[k - 1]
        shown[k] = reference[k - 1] + behind * np.exp(-1 / (rate * (0.6 if behind < 0 else 3.0)))
    channels = {"command": reference, "displacement": np.round(shown / 0.005) * 0.005}
    return Matrix(Actuator("LIFT"), (Run("steps", "", rate, channels, {"command": "V", "displacement": "m"}),))


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_what_follows_whole_runs_is_not_judged_by_windows():
    """Over windows that begin with a speed, for want of a better model of one that integrates, it is no better."""
    first, *others = compared_structures(lift())
    assert first.machine == "first_order"
    assert first.error["held_out"] < 0.06
    lags = ("two_tanks", "sprung_motor")  # a quick tank, or a light mass, leaves a lag
    apart = [one for one in others if one.machine not in lags]
    assert all(one.error["held_out"] > 3 * first.error["held_out"] for one in apart)


@pytest.mark.parametrize(("cylinder", "over"), [(0.86, None), (0.295, 900.0), (0.2, 900.0)])
def test_windows_count_where_a_machine_that_integrates_is_among_the_best_over_them(cylinder, over):
    """Windows that begin anew forgive a wrong machine what it has done before: they are for what integrates."""

    def fitted(horizon: float | None, windows: float, whole: float) -> SimpleNamespace:
        window = None if horizon is None else SimpleNamespace(horizon=horizon, memory=None)
        return SimpleNamespace(
            fit=SimpleNamespace(window=window),
            judged=lambda window: SimpleNamespace(error=whole if window is None else windows),
        )

    horizon, tried = _judged([fitted(None, 0.29, 0.33), fitted(900.0, cylinder, 0.87)])
    assert horizon == over
    assert tried[0].error == (0.33 if over is None else 0.29)


@pytest.mark.parametrize(("command", "strange"), [("V", True), ("rad", False)])
def test_a_motor_moves_along_a_way_as_a_rule_where_an_angle_drives_it_alone(command, strange):
    """An angle opens no valve: what it moves is a ball on a beam, or hangs on a drum."""
    channels = {"command": np.zeros(9), "displacement": np.zeros(9)}
    run = Run("r", "", RATE, channels, {"command": command, "displacement": "m"})
    assert unusual(preset("motor"), [run]) is strange
    assert not unusual(preset("open_valve"), [run])


@pytest.mark.parametrize(("likely", "over"), [(4472.0, 1.6), (4100.0, 5.3)])
def test_machines_are_judged_over_the_windows_by_which_one_of_them_makes_the_records_most_likely(likely, over):
    """Over long windows a ball on a beam, which integrates twice, was judged by a speed that none of them has."""

    def fitted(horizon: float, memory: float | None, of_own: float) -> SimpleNamespace:
        return SimpleNamespace(
            fit=SimpleNamespace(window=SimpleNamespace(horizon=horizon, memory=memory)),
            judged=lambda _window: SimpleNamespace(error=0.2, log_likelihood=of_own),
        )

    horizon, _ = _judged([fitted(1.6, 0.1, likely), fitted(5.3, None, 4205.0)])
    assert horizon == over


@pytest.mark.usefixtures("few_effects")
def test_of_equals_the_one_with_fewer_parameters_is_taken():
    """A motor's speed is fitted by a valve-controlled cylinder as well, with four parameters more."""
    first, *others = of_motor()
    assert (first.machine, first.parameters) == ("motor", 2)
    assert next(one for one in others if one.machine == "open_valve").parameters > 2


def speeds_of_a_cylinder() -> Matrix:
    """A valve of 50 ms and an oil column of 60 rad/s, V to m/s; exact from sample to sample, noise of 0.5 %."""
    swings = [1.0, 2 * 0.15 * 60.0, 60.0**2]
    poles = np.polymul([0.05, 1.0], swings)
    answer = cont2discrete(([0.2 * 60.0**2], poles), 1 / RATE)
    runs = []
    for number, use in enumerate(("fit", "fit", "verify")):
        rng = np.random.default_rng([4, number])
        u = np.repeat(rng.uniform(-1, 1, 20), 20)
        v = lfilter(answer[0][0], answer[1], u)
        channels = {"command": u, "velocity": v + 0.005 * v.std() * rng.standard_normal(len(v))}
        units = {"command": "V", "velocity": "m/s"}
        runs.append(Run(f"r{number}", "", RATE, channels, units, output="velocity", hold="zoh", use=use))
    return Matrix(Actuator("X", supply_pressure=1e7), tuple(runs))


def test_a_cylinder_is_found_by_its_speed():
    """Its supply pressure is stated. As if the speed were a pressure the gain of its valve was bounded: 18 %."""
    first, *_ = compared_structures(speeds_of_a_cylinder())
    assert first.machine == "open_valve"
    assert (first.error["held_out"] or 1.0) < 0.006


@pytest.mark.full
def test_a_speed_along_a_way_is_that_of_a_motor():
    """A cart behind a motor: a lag that is no machine leaves as little, but no friction and no spring act on it."""
    matrix = motor(8)
    along = (replace(run, units={"command": "V", "velocity": "m/s"}) for run in matrix.runs)
    found = {one.machine: one.error["held_out"] for one in compared_structures(replace(matrix, runs=tuple(along)))}
    assert next(iter(found)) == "motor"
    assert found["motor"] == pytest.approx(found["first_order"], rel=1e-2)


def test_where_the_channels_say_it_nothing_is_compared():
    (only,) = compared_structures(specimen(1))
    assert (only.machine, only.error["held_out"]) == ("specimen", None)


@pytest.mark.usefixtures("few_effects")
def test_what_was_compared_is_kept_with_the_fit():
    fit = replace(identify(motor(8), Settings(model="motor")), structures=of_motor())
    assert FitResult.from_json(fit.to_json()) == fit
    assert "structures" not in replace(fit, structures=()).to_json()


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_structures_are_compared_over_one_time():
    """A cylinder that disturbances moved: over whole runs a slow lag would leave less of it than what it is."""
    matrix = cylinder(2, wander=4e-3, seconds=60.0, uses=("fit", "fit", "verify"))
    (first, *others) = compared_structures(matrix)
    assert first.machine in ("open_valve", "motor")
    lag = next(one for one in others if one.machine == "first_order")
    over = re.findall(r"held-out error [\d.]+ % over ([\d.]+) s", " ".join(one.why for one in (first, *others)))
    assert len(over) == 3
    assert len(set(over)) == 1
    assert lag.error["held_out"] > 1.02 * first.error["held_out"]


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_more_parameters_do_not_make_up_for_an_effect():
    """A motor with a dead zone: a valve's and an oil's lags leave a little less than the motor, all of them far more
    than the noise; with the dead zone the motor leaves the noise.
    """
    lab = Lab.drawn(1002, hidden=True)
    first, *others = compared_structures(lab.measured())
    assert first.machine == "motor"
    alone = {one.machine: one.error["held_out"] for one in (first, *others)}
    assert alone.pop("motor") > 0.999 * min(alone.values())
    assert "with dead zone" in first.why


def arm(size: float, sign: float, use: str) -> Run:
    """v' = 3.3 (dead zone of 0.36 − v), two stops at ±1 rad, driven to and fro; steps of 1 ms, noise of 2 mrad."""
    rate, n = 50.0, 1000
    u = np.zeros(n)
    u[100:350], u[550:800] = sign * size, -sign * size
    x, v, out = -0.9 * sign, 0.0, np.zeros(n)
    for k in range(n):
        out[k] = x
        drive = float(np.sign(u[k])) * max(float(abs(u[k])) - 0.36, 0.0)
        for _ in range(20):
            beyond = x - min(max(x, -1.0), 1.0)
            v += 1e-3 * (3.3 * (drive - v) - 2e3 * beyond - (30.0 * v if beyond else 0.0))
            x += 1e-3 * v
    out += 2e-3 * np.random.default_rng([5, int(10 * size)]).standard_normal(n)
    units = {"command": "1", "displacement": "rad"}
    return Run(f"at {size}", "", rate, {"command": u, "displacement": out}, units, hold="zoh", use=use)


@cache
def arms() -> Matrix:
    """Six of its runs, two of them to verify."""
    sizes = (0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
    runs = (arm(size, (-1) ** i, "verify" if i > 3 else "fit") for i, size in enumerate(sizes))
    return Matrix(Actuator("ARM"), tuple(runs))


def test_an_arm_between_stops_is_a_motor_with_a_dead_zone(full):
    if not full:  # what this rests on has tests of its own
        pytest.skip("ten seconds: run with --full")
    first, *_ = compared_structures(arms())
    assert first.machine == "motor"
    assert "with dead zone" in first.why


@pytest.mark.full
def test_a_time_constant_at_its_bound_is_told():
    """A lag for what integrates asks for one without end, or for a gain without end; the machine itself for nothing."""
    found = {}
    for model in ("first_order", "motor"):
        fit = identify(arms(), Settings(model=model))
        models = CandidateModels.of(arms(), Settings(model=model))
        start = {models.preset.parameter(name).in_equations: value for name, value in fit.values.items()}
        found[model] = models.refit((), start).at_bounds
    assert found["first_order"] in (("tau",), ("gain",))
    assert found["motor"] == ()


@pytest.mark.parametrize(
    ("first", "other", "taken"), [(True, False, "motor"), (False, False, "lag"), (True, True, "lag")]
)
def test_one_that_asks_beyond_its_bound_gives_way_to_one_that_does_not(first, other, taken):
    def model(machine: str, error: float, at_bound: bool) -> SimpleNamespace:
        best = SimpleNamespace()
        return SimpleNamespace(
            machine=machine, parameters=2, error=error, best=best, with_effect=best, at_bound=at_bound
        )

    lag, motor = model("lag", 0.324, first), model("motor", 0.306, other)
    assert _preferred(lag, [lag, motor], {})[0].machine == taken
    assert _preferred(lag, [lag, motor], {"lag": 0.7, "motor": 0.3})[0].machine == "lag"


@pytest.mark.parametrize(("left", "taken"), [(0.03, "open_valve"), (0.0, "motor")])
def test_one_that_leaves_as_little_has_to_be_as_likely(left, taken):
    """A motor follows a cylinder nearly: where it leaves a little more of long records it is far less probable."""
    rng = np.random.default_rng(5)
    noise, shape = 0.03 * rng.standard_normal(3000), rng.standard_normal(3000)
    bands = EnergyBands((Record(1.0, floor=0.0009),), (3000,))

    def model(machine: str, parameters: int, more: float) -> SimpleNamespace:
        residuals = Residuals((noise + more * shape,), bands)
        best = SimpleNamespace(
            finite=True, held_out=SimpleNamespace(error=0.03), residuals_held_out=residuals, effects=()
        )
        return SimpleNamespace(machine=machine, size=parameters, error=0.03, best=best, at_bound=False)

    models = first, _ = model("open_valve", 6, 0.0), model("motor", 2, left)
    probable = _probabilities(models, (), ())
    assert _preferred(first, models, probable)[0].machine == taken


@pytest.mark.parametrize(
    ("probabilities", "taken"),
    [((0.3, 0.3, 0.4), "motor"), ((0.4, 0.3, 0.3), "open_valve"), ((0.2, 0.4, 0.4), "first_order")],
)
def test_the_most_probable_machine_is_taken(probabilities, taken):
    """Of equals the first."""
    models = first, *_ = [
        SimpleNamespace(machine=name, error=0.1, at_bound=False) for name in ("open_valve", "first_order", "motor")
    ]
    probable = dict(zip(("open_valve", "first_order", "motor"), probabilities, strict=True))
    assert _preferred(first, models, probable)[0].machine == taken
    assert _preferred(first, models, {})[0] is first
    assert _preferred(first, models, dict.fromkeys(probable, 1.0 / 3))[0] is first


def of_gains(integrates: bool = True, **gains: float) -> list[Any]:
    """Models of two parameters by their gains, in place of residuals."""
    return [
        SimpleNamespace(machine=name, size=2, error=-gain, integrates=integrates,
                        best=SimpleNamespace(residuals_held_out=gain))
        for name, gain in gains.items()
    ]  # fmt: skip


@pytest.fixture
def gains_for_residuals(monkeypatch: pytest.MonkeyPatch) -> None:
    """A residual is the gain of its model."""
    for name, instead in (("gain", lambda _first, of, _: of), ("common_disturbance", lambda _: None),
                          ("finite_everywhere", lambda _: True)):  # fmt: skip
        monkeypatch.setattr(structure_selection, name, instead)


@pytest.mark.usefixtures("gains_for_residuals")
@pytest.mark.parametrize(("ratio", "taken"), [(1.9, False), (2.1, True)])
def test_a_lag_is_taken_that_is_more_probable_than_a_machine(ratio, taken):
    """It has no parts on which friction and springs could act: it has to be twice as likely."""
    models = of_gains(motor=0.0, first_order=float(np.log(ratio)) / EVIDENCE_CRITERIA.learning_rate)
    probable = _probabilities(models, ("first_order",), ())
    assert (probable["first_order"] > probable["motor"]) is taken


@pytest.mark.usefixtures("gains_for_residuals")
@pytest.mark.parametrize(("ratio", "taken"), [(95.0, "open_valve"), (105.0, "motor")])
def test_an_unusual_machine_stands_for_the_usual_one_that_moves_alike(ratio, taken):
    """A motor that moves along a way, beside a cylinder: what it explains by fewer parameters is the cylinder's."""
    gain = float(np.log(ratio)) / EVIDENCE_CRITERIA.learning_rate
    lag = of_gains(False, first_order=gain - 1.0)
    probable = _probabilities([*of_gains(open_valve=0.0, motor=gain), *lag], ("first_order",), ("motor",))
    assert max(probable, key=lambda name: probable[name]) == taken
    assert sum(probable.values()) == pytest.approx(1.0)
    alone = _probabilities([*of_gains(motor=0.0), *lag], ("first_order",), ("motor",))
    assert alone["motor"] > 0.01  # nothing else integrates


@pytest.mark.parametrize(("probability", "said"), [(0.28, True), (0.72, False)])
def test_a_machine_that_is_more_probable_than_the_first_is_said_with_how_to_name_it(probability, said):
    """As a motor on a way beside a valve that has the smaller error: only the user knows which of them it is."""
    first, motor = SimpleNamespace(machine="open_valve"), SimpleNamespace(machine="motor")
    probable = {"open_valve": probability, "motor": 1.0 - probability}
    rather = structure_selection._rather(motor, first, probable)  # type: ignore[arg-type]
    assert ("--model motor" in str(rather)) is said
    assert structure_selection._rather(motor, first, {}) is None  # type: ignore[arg-type]


@pytest.mark.parametrize(("alone", "left", "named"), [(0.61, 0.005, True), (0.61, 0.2, False), (0.7, 0.005, False)])
def test_a_machine_with_more_parameters_has_to_explain_most_with_its_effect(alone, left, named):
    """Two tanks that run over are fitted no better than one lag; with the overflow they leave a hundredth of it."""
    noise, shape = 0.005 * np.random.default_rng(7).standard_normal(3000), np.sin(np.arange(3000) / 9.0)
    bands = EnergyBands((Record(1.0, floor=0.005**2),), (3000,))

    def model(machine: str, parameters: int, alone: float, left: float) -> SimpleNamespace:
        held_out, horizon = SimpleNamespace(error=left), SimpleNamespace(horizon=None)
        best = SimpleNamespace(
            finite=True,
            held_out=held_out,
            fitness=horizon,
            residuals_held_out=Residuals((noise + left * shape,), bands),
        )
        of = SimpleNamespace(machine=machine, parameters=parameters, error=alone, best=best, above_noise=left > 0.01,
                             size=parameters, with_effect=None)  # fmt: skip
        of.helped = of.helped_further = lambda _report: of
        return of

    lag, tanks = model("first_order", 2, 0.615, 0.51), model("two_tanks", 3, alone, left)
    assert ("two_tanks" in structure_selection._with_an_effect_each(lag, [lag, tanks], silent)) is named


@pytest.mark.parametrize(("alone", "found", "further"), [(0.375, 0.2, True), (0.3, 0.01, False), (0.405, 0.2, False)])
def test_a_model_about_as_good_as_the_best_is_tried_with_more_effects_where_none_explains_the_records(
    alone, found, further
):
    """The tanks without their overflow lie so far off that a prediction from there promises little of it."""

    def model(machine: str, error: float, left: float) -> SimpleNamespace:
        of = SimpleNamespace(machine=machine, parameters=3, error=error, above_noise=left > 0.1, asked=False,
                             size=3, with_effect=None)  # fmt: skip

        def helped_further(_report: object) -> SimpleNamespace:
            of.asked = True
            return of

        of.helped, of.helped_further = (lambda _report: of), helped_further
        return of

    spring, tanks = model("drive", 0.3, found), model("two_tanks", alone, 0.2)
    structure_selection._with_an_effect_each(spring, [spring, tanks], silent)
    assert tanks.asked is further


@pytest.mark.full
def test_tanks_that_overflow_are_no_mass_on_a_spring():
    of = Various.drawn(168504, hidden=True)
    assert (of.kind, of.hidden) == ("tanks", "overflow")
    first, *others = compared_structures(of.measured())
    assert first.machine == "two_tanks"
    assert "overflow" in first.why
    assert "drive" in {one.machine for one in others}


@pytest.mark.parametrize("model", short_form(["motor", "open_valve"], "motor"))
def test_a_cylinder_is_found_at_any_rate_of_samples(model):
    """At 4.6 kHz: the gain of a position in one of a drive was bounded by the position, as if it were a speed."""
    lab = sound(Lab.drawn(964, hidden=True))
    assert lab.rate > 4000
    fit = identify(lab.measured(), Settings(model=model))
    assert max(fit.error["fit"], fit.error["verify"]) < 2.0 * lab.noise


def test_an_effect_that_no_simulation_confirms_helps_no_model(monkeypatch):
    """Its error is infinite: taken with it, a sound model would be the worst of all."""
    fitted, unsound = (
        SimpleNamespace(finite=finite, effects=(), held_out=SimpleNamespace(error=0.3)) for finite in (True, False)
    )
    offered = [SimpleNamespace(refit=unsound, worth_adding=True, trial=unsound)]
    monkeypatch.setattr(structure_selection, "rank", lambda *_args, **_kwargs: offered)
    models = SimpleNamespace(effects={"dead_zone": None}, horizon=None, preset=preset("motor"))
    judged = structure_selection._JudgedStructure(models, 2, {}, fitted)
    assert judged.helped(silent).with_effect is None


@pytest.mark.parametrize(("std_error", "undetermined"), [(1.9, False), (2.1, True)])
def test_a_level_is_undetermined_that_is_known_to_no_better_than_the_whole_way_of_the_output(std_error, undetermined):
    run = Run("r", "", RATE, {"command": np.zeros(3), "velocity": np.array([0.0, 1.0, 2.0])}, {}, output="velocity")
    offsets = {"velocity": TransducerOffset(-50.0, "m/s", std_error), "force": TransducerOffset(9.0, "N", 1e3)}
    of = SimpleNamespace(matrix=Matrix(Actuator("X"), (run,)), fit=SimpleNamespace(transducer_offset=offsets))
    assert structure_selection._FittedStructure.level_undetermined.fget(of) is undetermined  # type: ignore[attr-defined]


@pytest.mark.parametrize(("integrating", "left"), [("windows", {"motor", "sound"}), (None, {"motor", "far", "sound"})])
def test_a_model_whose_level_is_undetermined_gives_way_where_another_integrates(monkeypatch, integrating, left):
    """As a mass on a spring that is next to none, whose far end is a constant force: others do not have one."""
    known = {
        "motor": SimpleNamespace(fit=SimpleNamespace(window=integrating), level_undetermined=False),
        "sound": SimpleNamespace(fit=SimpleNamespace(window=None), level_undetermined=False),
        "far": SimpleNamespace(fit=SimpleNamespace(window=None), level_undetermined=True),
    }
    monkeypatch.setattr(structure_selection, "_FittedStructure", lambda model, *_: known[model.name])
    models = [SimpleNamespace(name=name) for name in known]
    assert set(structure_selection._all_fitted(models, None, silent, {})) == left  # type: ignore[arg-type]
