"""A hundred sound records of many kinds of machine, simulated with SciPy: a check has no reason to doubt any of them.

Each is two measurements, one to fit and one to verify, with commands, noise and clocks of their own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from scipy.signal import cont2discrete, lfilter

from ident.matrix import Matrix
from ident.readers import from_arrays

Array = np.ndarray
Rng = np.random.Generator
Columns = dict[str, Array]
Draw = Callable[[Rng, Rng], tuple[Columns, dict[str, object]]]
"""Makes a record: what is drawn first is of the machine, then what is of the record alone."""


def swing(u: Array, rate: float, natural: float, damping: float) -> Array:
    """The answer of ω²/(s² + 2ζω s + ω²) to a held command, `natural` in Hz."""
    w = 2 * np.pi * natural
    numerator, denominator, _ = cont2discrete(([w**2], [1.0, 2 * damping * w, w**2]), 1 / rate)
    return lfilter(np.ravel(numerator), denominator, u)


def lag(u: Array, rate: float, tau: float) -> Array:
    """The answer of 1/(τ s + 1) to a held command."""
    kept = np.exp(-1 / (rate * tau))
    return lfilter([0.0, 1 - kept], [1.0, -kept], u)


def levels(rng: Rng, count: int, dwell: int) -> Array:
    """Random levels, each held for `dwell` samples."""
    return np.repeat(rng.uniform(-1, 1, count // dwell + 1), dwell)[:count]


def band(rng: Rng, count: int, rate: float, edge: float) -> Array:
    """Noise from 0 to `edge` in Hz, of deviation 1."""
    lines = np.fft.rfft(rng.standard_normal(count))
    lines[np.fft.rfftfreq(count, 1 / rate) > edge] = 0.0
    found = np.fft.irfft(lines, count)
    return found / found.std()


def noisy(rng: Rng, y: Array, share: float) -> Array:
    """With white noise of a share of the deviation."""
    return y + share * y.std() * rng.standard_normal(len(y))


def speed(u: Array, y: Array, rate: float, hold: str = "zoh", unit: str = "V") -> tuple[Columns, dict[str, object]]:
    """A record of a drive: command in, speed out."""
    stated = {"units": {"command": unit, "velocity": "rad/s"}, "output": "velocity", "hold": hold}
    return {"command": u, "velocity": y}, stated | {"sample_rate": f"{rate} Hz"}


def ringing(machine: Rng, rng: Rng) -> tuple[Columns, dict[str, object]]:
    """Held levels answered by a swing of any damping, 8 samples a cycle or more (the more damped, the more of them)."""
    rate, damping = 100.0, machine.choice([0.02, 0.05, 0.1, 0.2, 0.35, 0.6, 1.0])
    cycle = machine.uniform(8, 40) * (1 + 2 * damping)
    u = levels(rng, 1500, int(rng.integers(11, 60)))
    return speed(u, noisy(rng, swing(u, rate, rate / cycle, damping), rng.choice([0.0, 0.01, 0.03])), rate)


def rectified(machine: Rng, rng: Rng) -> tuple[Columns, dict[str, object]]:
    """The same seen by a counter that does not know the direction."""
    columns, stated = ringing(machine, rng)
    return columns | {"velocity": np.abs(columns["velocity"])}, stated


def resting(machine: Rng, rng: Rng) -> tuple[Columns, dict[str, object]]:
    """A machine that settles under a command held throughout, whose clock strays or whose recorder has noise."""
    rate, count = machine.choice([20.0, 100.0, 500.0]), 1200
    step = (1 + rng.choice([0.0, 0.08, 0.2, 0.4]) * rng.uniform(-1, 1, count)) / rate
    time, level = np.cumsum(step), machine.choice([1e-6, 0.1, -3.7, 230.0])
    y = level + (1 + abs(level)) * np.exp(-time / machine.uniform(0.1, 0.5) / time[-1]) * np.cos(
        time * machine.uniform(0, 6)
    )
    u = level + rng.choice([0.0, 1e-12, 1e-5, 1e-3, 1e-2]) * max(abs(level), 0.01) * rng.standard_normal(count)
    unit, name = machine.choice([("m", "displacement"), ("V", "velocity")])
    units = {"command": str(unit), str(name): "m" if name == "displacement" else "rad/s"}
    stated = {"units": units, "output": str(name), "hold": str(machine.choice(["zoh", "linear"]))}
    columns = {"t": time, "command": u, str(name): noisy(rng, y, 0.005)}
    return columns, stated | {"time": {"column": "t", "unit": "s"}}


def slow_sine(machine: Rng, rng: Rng) -> tuple[Columns, dict[str, object]]:
    """A position that follows a sine of 0.1 to 1 Hz, recorded command included."""
    rate, t = 200.0, np.arange(4000) / 200.0
    u = 0.01 * np.sin(2 * np.pi * (rng.uniform(0.1, 1.0) * t + rng.uniform()))
    x = noisy(rng, lag(u, rate, machine.uniform(0.01, 0.05)), 0.003)
    stated = {"units": {"command": "m", "displacement": "m"}, "kind": "sine", "sample_rate": "200 Hz"}
    return {"command": noisy(rng, u, rng.choice([0.0, 0.003])), "displacement": x}, stated


def one_step(machine: Rng, rng: Rng) -> tuple[Columns, dict[str, object]]:
    """One step up, or up and back, answered by a lag or a swing."""
    rate, count = 200.0, 2000
    u = np.zeros(count)
    u[100 : rng.choice([1000, count])] = rng.uniform(0.5, 8)
    tau, natural = machine.uniform(0.05, 0.5), machine.uniform(1, 8)
    clean = lag(u, rate, tau) if machine.random() < 0.5 else swing(u, rate, natural, 0.2)
    return speed(u, noisy(rng, clean, 0.005), rate, str(machine.choice(["zoh", "linear"])))


def staircase(machine: Rng, rng: Rng) -> tuple[Columns, dict[str, object]]:
    """Levels up and down again, answered by a lag."""
    up = np.arange(0, 8) * rng.choice([-0.5, 1.0, 3.0])
    u = np.repeat(np.concatenate([up, up[::-1]]), int(rng.integers(40, 160)))
    return speed(u, noisy(rng, lag(u, 50.0, machine.uniform(0.1, 0.6)), 0.005), 50.0)


def random_noise(machine: Rng, rng: Rng) -> tuple[Columns, dict[str, object]]:
    """Noise of a band with twelve samples a cycle or more, answered by a lag or a swing."""
    rate = machine.choice([200.0, 1000.0, 4096.0])
    u = band(rng, 8000, rate, rate / rng.uniform(12, 60))
    natural, damping = rate / machine.uniform(20, 80), machine.uniform(0.1, 1)
    y = swing(u, rate, natural, damping) if machine.random() < 0.5 else lag(u, rate, 20 / rate)
    return speed(noisy(rng, u, rng.choice([0.0, 0.005])), noisy(rng, y, 0.01), rate, "linear")


def damper(machine: Rng, rng: Rng) -> tuple[Columns, dict[str, object]]:
    """A damper moved by an actuator: viscous, with dry friction or a spring; motion in, force out."""
    rate, t = 200.0, np.arange(4000) / 200.0
    v = 0.1 * (band(rng, 4000, rate, 8.0) if rng.random() < 0.5 else np.sin(2 * np.pi * rng.uniform(0.5, 3) * t))
    x = np.cumsum(v) / rate
    force = machine.uniform(100, 900) * v + machine.choice([0.0, 900.0]) * (x - x.mean())
    force = noisy(rng, force + machine.choice([0.0, 20.0]) * np.tanh(v / 0.003), 0.01)
    stated = {"units": {"velocity": "m/s", "force": "N"}, "output": "force", "sample_rate": "200 Hz"}
    return {"velocity": noisy(rng, v, rng.choice([0.0, 0.01])), "force": force}, stated


def quantised(machine: Rng, rng: Rng) -> tuple[Columns, dict[str, object]]:
    """Any of the others in 20 to 200 steps of a converter."""
    columns, stated = (ringing, one_step, staircase, random_noise, damper)[machine.integers(5)](machine, rng)
    name = "force" if "force" in columns else "velocity"
    step = np.ptp(columns[name]) / machine.integers(20, 200)
    return columns | {name: np.round(columns[name] / step) * step}, stated


def sweep(machine: Rng, rng: Rng) -> tuple[Columns, dict[str, object]]:
    """A swept sine to a twelfth of the sample rate or less."""
    rate, t = 500.0, np.arange(6000) / 500.0
    u = np.sin(2 * np.pi * (0.5 * t + rng.uniform(0.3, 1.5) * t**2))
    return speed(u, noisy(rng, swing(u, rate, machine.uniform(5, 20), machine.uniform(0.1, 1)), 0.01), rate, "linear")


KINDS: dict[Draw, int] = {
    ringing: 14,
    rectified: 14,
    resting: 14,
    slow_sine: 8,
    one_step: 8,
    staircase: 6,
    random_noise: 10,
    damper: 10,
    quantised: 10,
    sweep: 6,
}
"""How many of each."""


def sound_records() -> Iterator[tuple[str, Matrix]]:
    """Name and matrix of each record."""
    for place, (draw, count) in enumerate(KINDS.items()):
        for number in range(count):
            yield f"{draw.__name__}-{number}", measured(draw, [place, number])


def measured(draw: Draw, seed: list[int]) -> Matrix:
    """Two measurements of one machine: what is drawn of it is the same, what is recorded is not."""
    parts = []
    for use in ("fit", "verify"):
        columns, stated = draw(np.random.default_rng(seed), np.random.default_rng([*seed, 1 + (use == "verify")]))
        parts.append(from_arrays(columns, **stated, id=use, use=use, actuator={"serial": "SOUND"}))
    return parts[0] + parts[1]
