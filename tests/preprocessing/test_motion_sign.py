"""Which records say that a motion is counted against the force that drives it: a mass, a damper or a spring."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import butter, cont2discrete, lfilter, lsim, sosfiltfilt

from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.preprocessing.motion_sign import against_its_drive
from ident.run import Run
from ident.workflows import identify

RATE = 100.0
MASS, DAMPER, SPRING, SWINGING = (1.0, 1.0, 1e-4), (0.01, 5.0, 1e-3), (1e-3, 0.1, 5.0), (1.0, 0.4, 60.0)


def driven(
    machine: tuple[float, float, float], sign: float, output: str = "displacement", seed: int = 0, noise: float = 0.02
) -> Run:
    """m x″ + c x′ + k x = p of a held pressure, by SciPy, with an offset of the reading and white noise."""
    rng = np.random.default_rng(seed)
    pressure = np.repeat(rng.uniform(0.0, 2e5, 25), 120)
    above = [1.0] if output == "displacement" else [1.0, 0.0]
    b, a, _ = cont2discrete((above, machine), 1 / RATE)
    moved = lfilter(b.ravel(), a, pressure)
    moved = sign * moved / np.ptp(moved)
    moved = moved + 3.0 + noise * rng.standard_normal(len(moved))
    channels, units = {"command": pressure, output: moved}, {"command": "Pa", output: "m"}
    return Run(f"run-{seed}", "", RATE, channels, units, hold="zoh", output=output)


@pytest.mark.parametrize(
    ("machine", "output"),
    [
        (MASS, "velocity"),
        (DAMPER, "displacement"),
        (DAMPER, "velocity"),
        (SPRING, "displacement"),
        (SWINGING, "displacement"),
    ],
)
def test_mass_damper_and_spring_have_the_sign_of_what_drives_them(
    machine: tuple[float, float, float], output: str
) -> None:
    """Whatever the reading's zero is."""
    for sign in (1.0, -1.0):
        assert against_its_drive(driven(machine, sign, output)) is (sign < 0)


@pytest.mark.parametrize("machine", [MASS, SWINGING, (2.0, 8.0, 32.0)])
def test_an_accelerometer_that_is_mounted_the_other_way_round_is_told(machine: tuple[float, float, float]) -> None:
    """Its zero counts no more than that of a position: a(s) = s² p(s) / (m s² + c s + k), by SciPy."""
    rng, time = np.random.default_rng(2), np.arange(3000) / RATE
    force = sosfiltfilt(butter(2, [0.2, 10.0], "bandpass", fs=RATE, output="sos"), rng.standard_normal(len(time)))
    _, shown, _ = lsim(([1.0, 0.0, 0.0], machine), force, time)
    shown = shown + shown.std() * (1.0 + 0.005 * rng.standard_normal(len(shown)))
    for sign in (1.0, -1.0):
        channels, units = {"command": force, "acceleration": sign * shown}, {"command": "V", "acceleration": "m/s^2"}
        assert against_its_drive(Run("r", "", RATE, channels, units, output="acceleration")) is (sign < 0)


def test_a_drift_of_a_mass_alone_is_turned_by_nothing() -> None:
    """Integrated twice, what drifts away is next to a polynomial, and the rest of it fits either sign."""
    for seed in range(5):
        assert not against_its_drive(driven(MASS, 1.0, seed=seed))


def test_a_motion_that_the_drive_does_not_explain_tells_no_sign() -> None:
    noise = np.random.default_rng(1).standard_normal(2000)
    channels, units = {"command": noise, "displacement": noise[::-1].copy()}, {"command": "Pa", "displacement": "m"}
    assert against_its_drive(Run("r", "", RATE, channels, units)) is None
    channels = {"command": noise, "displacement": np.zeros(2000)}
    assert against_its_drive(Run("r", "", RATE, channels, units)) is None


def positioned(gain: float, dry: float, share: float, seed: int = 0) -> Run:
    """A motor that a limited proportional controller steps to 100 counts, by Euler's steps.

    It has dry friction, and a mass on a spring that swings on it; the record is that of the controller's output.
    """
    rng, steps, rate = np.random.default_rng(seed), 10, 500.0
    step, count = 1.0 / (rate * steps), 2000
    drive, read = np.zeros(count), np.zeros(count)
    way = speed = stretch = relative = 0.0
    for k in range(count):
        read[k] = way + 0.5 * rng.standard_normal()
        drive[k] = np.clip(gain * ((100.0 if k > 50 else 0.0) - read[k]), -200.0, 200.0)
        for _ in range(steps):
            pull = 15.9**2 * stretch
            gained = 400.0 * drive[k] - 34.0 * speed - dry * np.tanh(speed / 2.0) + share * pull
            relative, speed = relative - step * (pull + gained), speed + step * gained
            stretch, way = stretch + step * relative, way + step * speed
    channels, units = {"command": drive, "displacement": read}, {"command": "1", "displacement": "1"}
    return Run(f"step-{seed}", "", rate, channels, units, hold="zoh", output="displacement")


@pytest.mark.parametrize(("gain", "dry", "share"), [(2.0, 0.0, 1.7), (2.0, 2000.0, 1.7), (4.0, 6000.0, 0.0)])
def test_a_controller_that_drives_back_is_no_spring_of_the_other_sign(gain: float, dry: float, share: float) -> None:
    """u = k (r - x) is the balance of a spring that is counted the other way; the motor takes work of its drive."""
    for seed in range(2):
        assert not against_its_drive(positioned(gain, dry, share, seed))


@pytest.mark.full
def test_a_muscle_that_contracts_under_pressure_is_a_mass_on_a_spring():
    """As recorded, its motion is counted against the pressure, and its spring would be negative."""
    muscle = Matrix(Actuator("MUSCLE"), (driven(SWINGING, -1.0), driven(SWINGING, -1.0, seed=1)))
    fit = identify(muscle, Settings(model="pressure_drive"))
    assert any("taken with the other sign" in note for note in fit.notes)
    assert fit.parameters["k0/Ap"].value / fit.parameters["m0/Ap"].value == pytest.approx(60.0, rel=0.02)
    assert fit.error["fit"] < 0.2
    as_recorded = Settings(model="pressure_drive", preprocessing={"force_sign": False})
    assert identify(muscle, as_recorded).error["fit"] > 0.9


def test_a_motor_whose_encoder_counts_the_other_way_is_a_motor():
    """As recorded, its torque constant would be negative, and a motor without a sign explains nothing."""
    recorded = driven(DAMPER, -1.0, "velocity")
    volts = {"command": recorded.command * 1e-4, "velocity": recorded.measured - 3.0}
    run = Run("r", "", RATE, volts, {"command": "V", "velocity": "rad/s"}, hold="zoh", output="velocity")
    fit = identify(Matrix(Actuator("MOTOR"), (run,)), Settings(model="motor"))
    assert any("taken with the other sign" in note for note in fit.notes)
    assert fit.error["fit"] < 0.1
