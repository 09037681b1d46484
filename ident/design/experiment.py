"""A further run of the lab: its conditions, its command signal, what it is expected to tell; and its files."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.design.excitation import KINDS, PERIODIC, excitation
from ident.run import Specimen
from ident.words.conditions import amplitude
from ident.words.percent import percent
from ident.words.result_tables import Listing, TabularResult

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Experiment(TabularResult):
    """One run. `amplitude` is the command's RMS in m, `frequency` that of a sine or saw-tooth, else the upper edge.

    `separation` are the standard deviations of the noise by which the rivals are expected to differ after
    refitting, `so_far` the same for the runs there are, `typical` for a run chosen at random; None for one rival.
    `information` is the expected gain in nats of the joint knowledge of the parameters, `std_errors` the share of each
    standard error that is expected to be left.
    """

    specimen: Specimen | None
    gain: float | None
    amplitude: float
    signal: str
    frequency: float
    seconds: float
    sample_rate: float
    seed: int = 0
    unit: str = "m"
    time_unit: str = "s"
    separation: float | None = None
    so_far: float | None = None
    typical: float | None = None
    information: float = 0.0
    std_errors: Mapping[str, float] = field(default_factory=dict)
    text: str = ""

    @property
    def samples(self) -> int:
        """Length of the command."""
        return max(64, round(self.seconds * self.sample_rate))

    def command(self) -> Array:
        """The command in the unit of `amplitude`, (n,); the same each time."""
        return excitation(self.signal, self.amplitude, self.samples, self.sample_rate, self.frequency, self.seed)

    def lasting(self, seconds: float) -> Experiment:
        """The same for another time."""
        return replace(self, seconds=seconds)

    @property
    def conditions(self) -> str:
        """The run in words."""
        size = amplitude(float(f"{self.amplitude:.3g}"), self.unit)
        rate = "Hz" if self.time_unit == "s" else "cycles/sample"
        where = f"at {self.frequency:.3g} {rate}" if self.signal in PERIODIC else f"up to {self.frequency:.3g} {rate}"
        parts = [f"{self.signal} of {size} RMS {where}"]
        if self.specimen is not None:
            parts.append(_words(self.specimen))
        if self.gain is not None:
            parts.append(f"Kp {self.gain:g}")
        return ", ".join((*parts, f"{self.seconds:g} {'s' if self.time_unit == 's' else 'samples'}"))

    def listings(self) -> Iterator[Listing | str]:
        """What is to be run, by how much the rivals are expected to differ, and why, in words."""
        yield Listing("next run", ("condition", ""), [("command", self.conditions), *self._expected()])
        if self.text:
            yield self.text

    def _expected(self) -> Iterator[tuple[str, str]]:
        """What is expected of it, as far as it is known."""
        differences = {"this run": self.separation, "the runs so far": self.so_far, "a run by chance": self.typical}
        for name, deviations in differences.items():
            if deviations is not None:
                yield f"rivals differ in {name}", f"{deviations:.3g} standard deviations of the noise"
        for name, share in self.std_errors.items():
            yield f"standard error of {name}", f"{percent(share)} of today's"

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data (no NaN, no infinity)."""
        s = self.specimen
        specimen = None if s is None else {"mass": s.mass, "stiffness": s.stiffness, "damping": s.damping}
        return {
            "specimen": specimen,
            "gain": self.gain,
            "amplitude": self.amplitude,
            "unit": self.unit,
            "signal": self.signal,
            "frequency": self.frequency,
            "seconds": self.seconds,
            "sample_rate": self.sample_rate,
            "seed": self.seed,
            "separation": self.separation,
            "so_far": self.so_far,
            "typical": self.typical,
            "information": self.information,
            "std_errors": dict(self.std_errors),
            "text": self.text,
        }

    def entry(self) -> dict[str, Any]:
        """The run as matrix.yaml wants it, once it was recorded beside the command."""
        specimen = self.specimen and {
            "mass": f"{self.specimen.mass:g} kg",
            "stiffness": f"{self.specimen.stiffness:g} N/m",
            "damping": f"{self.specimen.damping:g} N*s/m",
        }
        found = {
            "id": f"next-{self.signal}",
            "file": "runs/next.csv",
            "sample_rate": f"{self.sample_rate:g} Hz",
            "specimen": specimen,
            "gain": self.gain,
            "amplitude": f"{self.amplitude:g} {self.unit}",
            "kind": KINDS[self.signal],
            "use": "fit",
        }
        return {key: value for key, value in found.items() if value is not None}

    def write(self, out: Path) -> None:
        """command.csv and command.mat (time, command), and experiment.json, into the folder `out`."""
        from scipy.io import savemat  # noqa: PLC0415

        out.mkdir(parents=True, exist_ok=True)
        command = self.command()
        time = np.arange(len(command)) / self.sample_rate
        scale, unit = (1e3, "mm") if self.unit == "m" else (1.0, self.unit)
        header = f"time_{self.time_unit},command_{unit}"
        np.savetxt(
            out / "command.csv", np.column_stack([time, scale * command]), "%.9g", ",", header=header, comments=""
        )
        columns = {"time": time, "command": scale * command, "unit": unit, "sample_rate": self.sample_rate}
        savemat(out / "command.mat", columns, oned_as="column")
        about = {**self.to_json(), "run": self.entry()}
        (out / "experiment.json").write_text(json.dumps(about, indent=2, allow_nan=False) + "\n", encoding="utf-8")


def _words(specimen: Specimen) -> str:
    """A specimen as far as it is not zero."""
    parts = ((specimen.mass, "kg"), (specimen.stiffness / 1e3, "kN/m"), (specimen.damping, "N*s/m"))
    said = ", ".join(f"{value:g} {unit}" for value, unit in parts if value)
    return f"specimen {said}" if said else "no specimen"
