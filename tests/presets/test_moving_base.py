"""A mass on a base that is moved, by an accelerometer or by its motion against the base: a reference of its own."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import butter, sosfiltfilt

from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.presets.suitable_models import in_question
from ident.readers.column_names import channel_of
from ident.readers.run_description import describe_run
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.conftest import of_few_effects

Array = NDArray[np.float64]
RATE, SUBSTEPS, NOISE = 200.0, 20, 0.005
FREQUENCY, DAMPING = 2 * np.pi * 1.8, 0.03
G = 9.80665


@dataclass(frozen=True)
class Storey:
    """A mass of 1 kg on a spring: r'' + 2 ζ ω r' + ω² (r + κ r³) = −a_B, with r against the base.

    A share of it, `upper`, hangs behind a second spring, whose frequency is 4 Hz with the lower mass held.
    """

    cubic: float = 0.0
    upper: float = 0.0

    def shaken(self, base: Array) -> dict[str, Array]:
        """What sensors show, by steps of symplectic Euler: accelerations in space, the position against the base."""
        x = v = x1 = v1 = 0.0
        shown = {name: np.empty(len(base)) for name in ("acceleration", "displacement", "upper")}
        following, dt, frequency = np.append(base[1:], base[-1]), 1 / RATE / SUBSTEPS, 2 * np.pi * 4.0
        for k, (now, then) in enumerate(zip(base, following, strict=True)):
            for step in range(SUBSTEPS):
                ground = now + (then - now) * step / SUBSTEPS
                force = FREQUENCY**2 * (x + self.cubic * x**3) + 2 * DAMPING * FREQUENCY * v
                pull = frequency**2 * (x - x1) + 2 * 0.1 * frequency * (v - v1)
                in_space = -(force + self.upper * pull) / (1 - self.upper)
                if step == 0:
                    shown["acceleration"][k], shown["displacement"][k], shown["upper"][k] = in_space, x, pull
                v1 += dt * (pull - ground)
                x1 += dt * v1
                v += dt * (in_space - ground)
                x += dt * v
        return shown

    def measured(self, sensor: str, seconds: float = 20.0, seed: int = 5, late: int = 0) -> Matrix:
        """Three runs of noise at three amplitudes, the last to validate; the sensor's clock is so many samples late.

        Where it is late the base rests at first.
        """
        rng, runs = np.random.default_rng(seed), []
        band = butter(2, [0.3, 8.0], "bandpass", fs=RATE, output="sos")
        output = "displacement" if sensor == "displacement" else "acceleration"
        units = {"command": "m/s^2", output: "m" if output == "displacement" else "m/s^2"}
        for number, size in enumerate((2.0, 1.0, 1.5)):
            base = sosfiltfilt(band, rng.standard_normal(round(seconds * RATE)))
            base = np.append(np.zeros(2 * late), base * size / base.std())
            shown = self.shaken(base)[sensor][: len(base) - late]
            base = base[late:]
            shown = shown + NOISE * shown.std() * rng.standard_normal(len(shown))
            runs.append(
                Run(
                    f"r{number}",
                    "",
                    RATE,
                    {"command": base, output: shown},
                    units,
                    output=output,
                    use="verify" if number == 2 else "fit",
                )
            )
        return Matrix(Actuator("TABLE"), tuple(runs))


@pytest.mark.parametrize("output", ["acceleration", "displacement"])
def test_frequency_and_damping_of_a_mass_on_its_base(output):
    """No model is named: an acceleration is the command of a base. Without a force the mass is 1 kg by convention."""
    matrix = Storey().measured(output)
    assert [model.name for model in in_question(matrix.runs)] == ["moving_base"]
    found = identify(matrix)
    assert found.model == "moving_base"
    assert found.error["verify"] < 1.1 * NOISE
    assert found.parameters["m0"].fixed
    assert np.sqrt(found.values["k0"]) == pytest.approx(FREQUENCY, rel=1e-3)
    assert found.values["c0"] == pytest.approx(2 * DAMPING * FREQUENCY, rel=0.02)


def test_a_second_storey_is_named_by_its_accelerations(full):
    """What hangs on the mass moves with the base, too: the spring to it carries that force of inertia."""
    matrix = Storey(upper=0.3).measured("acceleration", 12.0)
    with of_few_effects(full, "elastic_load"):
        found = diagnose(matrix, identify(matrix), propose=False)
    assert found.verdict.effects == ("elastic_load",)
    assert found.ladder[0].error["verify"] > 10 * NOISE
    assert found.ladder[-1].error["verify"] < 1.1 * NOISE


def test_recorders_of_base_and_mass_whose_clocks_differ(full):
    """By a fifth of a period of the mass: its frequency and damping are lost until the delay is named."""
    late = 22
    matrix = Storey().measured("acceleration", 15.0, late=late)
    with of_few_effects(full, "command_delay", "elastic_load", "presliding_friction"):
        found = diagnose(matrix, identify(matrix), propose=False)
    assert found.verdict.effects == ("command_delay",)
    assert found.ladder[0].error["verify"] > 0.5
    last = found.ladder[-1]
    assert last.error["verify"] < 2 * NOISE
    assert last.parameters["command_delay.delay"].value == pytest.approx(late / RATE, rel=1e-2)
    assert np.sqrt(last.parameters["k0"].value) == pytest.approx(FREQUENCY, rel=1e-3)


def test_the_upper_storey_may_be_the_one_that_is_recorded():
    """Its accelerometer shows the pull of its spring."""
    matrix = Storey(upper=0.3).measured("upper")
    found = identify(matrix, Settings(model="moving_base", effects=("elastic_coupling",)))
    assert found.error["verify"] < 1.1 * NOISE
    assert found.values["elastic_coupling.share"] == pytest.approx(0.3, abs=0.01)


def test_a_spring_that_hardens_over_its_base():
    """Effects of a load act on the motion against the base."""
    matrix = Storey(cubic=40.0).measured("acceleration")
    linear = identify(matrix, Settings(model="moving_base"))
    found = identify(matrix, Settings(model="moving_base", effects=("cubic_stiffness",)))
    assert linear.error["verify"] > 10 * NOISE
    assert found.error["verify"] < 1.1 * NOISE
    assert found.values["cubic_stiffness.stiffness"] == pytest.approx(40.0 * FREQUENCY**2, rel=0.02)


def test_an_accelerometer_on_a_mass_that_a_force_drives():
    """The same sensor without a base that moves: mass, damping and spring in their own units."""
    rng, runs = np.random.default_rng(7), []
    mass, damping, stiffness = 3.0, 8.0, 2e3
    for use in ("fit", "verify"):
        force = sosfiltfilt(butter(2, 30.0, fs=RATE, output="sos"), 20.0 * rng.standard_normal(3000))
        x = v = 0.0
        shown = np.empty(len(force))
        for k, (now, then) in enumerate(zip(force, np.append(force[1:], force[-1]), strict=True)):
            for step in range(SUBSTEPS):
                pushed = now + (then - now) * step / SUBSTEPS - damping * v - stiffness * x
                if step == 0:
                    shown[k] = pushed / mass
                v += pushed / mass / RATE / SUBSTEPS
                x += v / RATE / SUBSTEPS
        channels = {"command": force, "acceleration": shown}
        runs.append(
            Run(use, "", RATE, channels, {"command": "N", "acceleration": "m/s^2"}, output="acceleration", use=use)
        )
    found = identify(Matrix(Actuator("SHAKER"), tuple(runs)))
    assert found.model == "drive"
    assert found.error["verify"] < 0.01
    assert found.values["m0"] == pytest.approx(mass, rel=0.01)
    assert found.values["k0"] == pytest.approx(stiffness, rel=0.01)
    assert found.values["c0"] == pytest.approx(damping, rel=0.05)


def test_accelerations_are_read_in_g():
    """``g`` is the standard gravity, of a command as well, and no gram; the answer is the output without a word."""
    channels = {"command": {"column": "base", "unit": "g"}, "acceleration": {"column": "top", "unit": "g"}}
    run = describe_run({"id": "r", "file": "r.csv", "sample_rate": "200 Hz", "channels": channels}, "runs[0]")
    assert run.outputs == ("acceleration",)
    assert {name: (channel.scale.factor, channel.scale.unit) for name, channel in run.channels.items()} == {
        "command": (G, "m/s^2"),
        "acceleration": (G, "m/s^2"),
    }
    assert channel_of("Ground acceleration (g)") == "command"
    assert channel_of("Floor acceleration [m/s^2]") == "acceleration"
    assert channel_of("Beschleunigung") == "acceleration"
    assert channel_of("measured", "m/s^2") == "acceleration"


def test_how_far_a_mass_goes_is_told_by_its_acceleration():
    """Integrated twice: of a sine of 3 mm and 2 Hz, beside noise that would drift by metres."""
    t = np.arange(4000) / RATE
    a = 3e-3 * (2 * np.pi * 2.0) ** 2 * np.sin(2 * np.pi * 2.0 * t)
    a += 0.02 * a.std() * np.random.default_rng(1).standard_normal(len(a))
    run = Run("r", "", RATE, {"acceleration": a}, output="acceleration")
    assert run.motion == pytest.approx(3e-3 / np.sqrt(2), rel=0.02)
    assert run.speed == pytest.approx(3e-3 * 2 * np.pi * 2.0 / np.sqrt(2), rel=0.02)
    shaken = Run("r", "", RATE, {"command": -a / 3, "acceleration": a}, {"command": "m/s^2"}, output="acceleration")
    assert shaken.motion == pytest.approx(4 / 3 * run.motion)
