"""Machines whose transducer is off, of a structure that is known: what a fit says of the offset and of the parameters.

python -m tests.blind.offsets 171001 171200

The machines are those of :mod:`tests.blind.various`, integrated by SciPy. A transducer has one offset in all runs, of
up to three deviations of its output. Its zero is not stated, or said not to be set. Runs differ in their
operating points, where the machine has some, and begin at rest or while the machine is moving. Noise is white or has a
colour.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.signal import lfilter

from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.readers import from_arrays
from ident.run import Run
from ident.workflows import identify
from tests.blind.campaign import add
from tests.blind.interval import rate_line
from tests.blind.various import COUNT, KINDS, RATE, Various

SEARCH = {"population": 20.0, "generations": 6.0, "elite": 3.0}
TOLD = 1.5
"""Times the noise: above it an offset is the larger part of the residual, and has to stand in the headline."""
BEFORE = 200  # samples in which a machine that moves already has been moving
OF_MACHINES = (
    ("motor", ""),
    ("motor", "quadratic_damping"),
    ("positioner", ""),
    ("mass", ""),
    ("mass", "cubic_stiffness"),
    ("inertia", ""),
    ("arm", ""),
    ("specimen", ""),
)
Array = np.ndarray
Row = dict[str, Any]


@dataclass(frozen=True)
class Off:
    """One machine whose transducer is `offset` off, in deviations of its first run; `colour` is that of the noise.

    The noise is n_k = colour n_(k−1) + e_k. `levels` are the operating points of the runs, `zeroed` what is stated.
    """

    machine: Various
    offset: float
    colour: float
    zeroed: bool | None
    moving: bool
    levels: tuple[float, ...]

    @classmethod
    def drawn(cls, seed: int) -> Off:
        """A machine by its seed."""
        rng = np.random.default_rng([177, seed])
        kind, hidden = OF_MACHINES[rng.integers(len(OF_MACHINES))]
        free = kind in ("motor", "mass", "inertia", "arm")
        machine = replace(
            Various.drawn(seed, hidden=False),
            kind=kind,
            hidden=hidden,
            unknown=False,
            level=0.0,
            hold="band-limited" if kind == "specimen" else str(rng.choice(["zoh", "linear"])),
            noise=float(10 ** rng.uniform(-2.6, -1.3)),
        )
        return cls(
            machine,
            float(rng.uniform(-3.0, 3.0)),
            float(rng.choice([0.0, rng.uniform(0.3, 0.95)])),
            None if rng.random() < 0.6 else False,
            bool(rng.integers(2)),
            tuple(free * rng.uniform(-0.5, 0.5, 3)),
        )

    def measured(self) -> Matrix:
        """Two runs to fit and one to verify."""
        clean = [self._clean(number) for number in range(3)]
        off = self.offset * float(clean[0][1].std())
        runs = tuple(self._run(number, u, y + off) for number, (u, y) in enumerate(clean))
        return Matrix(Actuator("OFF"), runs)

    def _clean(self, number: int) -> tuple[Array, Array]:
        rng = np.random.default_rng([178, self.machine.seed, number])
        of = replace(self.machine, level=self.levels[number])
        u = of.command(rng)
        if of.kind == "specimen":
            return u, of.answered(u)
        before = of.command(rng)[:BEFORE] if self.moving else np.zeros(0)
        y = of.answered(np.concatenate([before, u]))
        return u, y[len(before) :]

    def _run(self, number: int, u: Array, y: Array) -> Run:
        rng = np.random.default_rng([179, self.machine.seed, number])
        white = rng.standard_normal(BEFORE + COUNT)
        noise = lfilter([np.sqrt(1.0 - self.colour**2)], [1.0, -self.colour], white)[BEFORE:]
        of_command, output, of_output, _, _ = KINDS[self.machine.kind]
        moved = "displacement" if self.machine.kind == "specimen" else "command"
        use = ("fit", "fit", "verify")[number]
        channels = {moved: u, output: y + self.machine.noise * y.std() * noise}
        stated: dict[str, Any] = {} if self.machine.hold == "band-limited" else {"hold": self.machine.hold}
        (run,) = from_arrays(
            channels,
            units={moved: of_command, output: of_output},
            output=output,
            sample_rate=f"{RATE} Hz",
            id=f"{use}-{number}",
            use=use,
            actuator={"serial": "OFF"},
            **stated,
        ).runs
        return run if self.zeroed is None else replace(run, zeroed={output: self.zeroed})

    @property
    def truths(self) -> Mapping[str, float]:
        """Of what is determined, by its name in a result, SI."""
        of = self.machine
        time = 1.0 / (of.quick * RATE)  # s
        if of.kind in ("motor", "positioner"):
            drag = 1.5 * of.strength / 30.0 / time  # of a mass of 1, by convention
            return {"Kt / c0": 30.0, "m0 / c0": time, "Kt / m0": 30.0 / time, "quadratic_damping.coefficient": drag}
        if of.kind == "inertia":
            return {"c0": 0.1, "m0": 0.1 * time}
        if of.kind == "specimen":
            return {"kS": 3e4, "cS": 2e4 * of.damping / of.quick / RATE, "kS / cS": 1.5 * of.quick * RATE / of.damping}
        k = 100.0 if of.kind == "mass" else 1.0 / 1.5
        cube = 1e6 * of.strength * (of.hidden == "cubic_stiffness")
        return {"k0": k, "c0": 2.0 * of.damping * k * time, "m0": k * time**2, "cubic_stiffness.stiffness": cube}

    def fitted(self) -> tuple[Matrix, FitResult]:
        """The records and the fit of the structure that they have."""
        matrix, effects = self.measured(), (self.machine.hidden,) if self.machine.hidden else ()
        settings = Settings(model=KINDS[self.machine.kind][3], effects=effects, options=SEARCH, seed=1)
        return matrix, identify(matrix, settings)


def trial(seed: int) -> Row:
    """What a fit says of one machine: `z` of each parameter and of the offset, and what its headline says."""
    off = Off.drawn(seed)
    matrix, found = off.fitted()
    known = {name: (one.value, one.std_error) for name, one in found.parameters.items() if one.std_error}
    known |= {one.expression: (one.value, one.std_error) for one in found.determined}
    of, truths = off.machine, off.truths
    z = {name: (value - truths[name]) / error for name, (value, error) in known.items() if error and name in truths}
    size = float(off._clean(0)[1].std())
    offset = found.transducer_offset.get(KINDS[of.kind][1])
    if offset is not None:
        z["offset"] = (offset.value - off.offset * size) / offset.std_error
    place = of.kind == "positioner"  # it has no zero of its own
    return {
        "seed": seed,
        "kind": of.kind,
        "hidden": of.hidden,
        "offset": off.offset,
        "noise": of.noise,
        "colour": off.colour,
        "zeroed": off.zeroed,
        "moving": off.moving,
        "z": z,
        "large": not place and abs(off.offset) > TOLD * of.noise,
        "said": "offset of" in found.headline or "with the mean" in found.headline,
        "found": offset is not None,
        "errors": [found.error["verify"], found.error_with_mean["verify"]],
        "rmse": [found.rmse["verify"], of.noise * float(matrix.runs[2].measured.std())],
        "headline": found.headline,
    }


def scores(everything: Sequence[Row], offsets: bool) -> Array:
    """Errors over standard errors, of the offsets or of all else."""
    return np.array([z for row in everything for name, z in row["z"].items() if (name == "offset") == offsets])


def rates(everything: Sequence[Row]) -> Iterable[str]:
    """Counts with 95 % intervals."""
    large = [row for row in everything if row["large"]]
    yield "| what | count | rate in % (95 % interval) | goal |"
    yield "|---|---|---|---|"
    yield _counted("a headline that hides the offset", [not row["said"] for row in large], "none")
    yield _counted("an offset that is found", [row["found"] for row in large], "–")
    near = [row["rmse"][0] < 1.3 * row["rmse"][1] for row in everything]
    yield _counted("validation with its mean within 1.3 times the noise", near, "–")
    for what, of in (("parameters", scores(everything, False)), ("offsets", scores(everything, True))):
        yield _counted(f"{what} within three standard errors", (np.abs(of) < 3.0).tolist(), "98 %")
        yield f"| z of {what}, RMS | {len(of)} | {np.sqrt(np.mean(of**2)):.2f} | 0.8 to 1.25 |"


def _counted(what: str, hits: Sequence[bool], goal: str) -> str:
    return rate_line(what, sum(hits), len(hits), goal)


def main() -> None:
    """Run what is asked for, and sum up."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("first", type=int)
    parser.add_argument("last", type=int)
    parser.add_argument("--out", type=Path, help="a file to which each row is added")
    asked = parser.parse_args()
    found = []
    for seed in range(asked.first, asked.last + 1):
        found.append(trial(seed))
        if asked.out:
            add(found[-1], asked.out)
    print("\n".join(rates(found)))


if __name__ == "__main__":
    main()
