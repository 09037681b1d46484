"""`python -m tests.bench.calibration [SEEDS [FIRST]]`: standard errors against what is wrong, a row a quantity.

The judge is the reference: its actuators, read by converters of 10 to 16 bits and by gauges of 0.02 and 0.2 MPa RMS. z
is what is wrong over its standard error: of honest errors its RMS over many sets is 1 and its mean 0.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from itertools import product

import numpy as np

from ident.bench.acceptance import found_quantities
from ident.bench.analysis import Analysis, analyse
from tests.bench.sets import as_set
from tests.reference import kononykhin_reference as reference

BITS, GAUGES = (10, 12, 14, 16), (0.02, 0.2)  # of every converter; MPa RMS of each gauge
INSTRUMENTS = [reference.Instruments(bits, noise, bits, anywhere=0.1) for noise, bits in product(GAUGES, BITS)]
PLACES = (np.arange(32) + 0.5) / 32  # of a way within a step of the converter


def truth_of(truth: reference.Truth, records: Sequence[reference.Record], bits: int) -> dict[str, float]:
    """Every quantity of the sheet as the reference has it, SI."""
    u = np.linspace(-100, 100, 201)
    v, u = 1e-3 * truth.speed(u), u / 100
    line = np.polyfit(u, v, 1)
    forward, back = (float(u[s] @ v[s] / (u[s] @ u[s])) for s in (u > 0, u < 0))
    return {
        "zero_shift": truth.I0 / 100,
        "dead_space": truth.dead_space / 100,
        "hysteresis": truth.B / 100,
        "kp": 1e8 * truth.kp,
        "friction": 1e6 * truth.dPfr,
        "T": truth.T,
        "delay": truth.delay,
        "gain": line[0],
        "gain_forward": forward,
        "gain_back": back,
        "asymmetry": 2 * (forward - back) / (forward + back),
        "nonlinearity": float(np.max(np.abs(v - np.polyval(line, u))) / np.max(np.abs(v))),
        "position_error": float(np.mean([_of_converter(r, bits) for r in records if r.kind == "frequency"])),
    }


def _of_converter(record: reference.Record, bits: int) -> float:
    """What a true model leaves of a sine: the converter's error over the deviation, a mean over places in a step."""
    step, x = reference.STROKE / 2**bits, record.true_position[round(reference.RATE / record.frequency) :]
    seen = step * np.round(x / step + PLACES[:, None])
    seen = seen[np.ptp(seen, axis=1) > 0]  # from the other places a converter sees nothing of a motion within a step
    return float(np.mean(np.std(seen - x, axis=1) / np.std(seen, axis=1)))


def wrong(seed: int, read: reference.Instruments) -> dict[str, float]:
    """z of every quantity of the sheet, and of the static procedure's own, for one actuator and its instruments."""
    truth = reference.scattered(seed)
    records = reference.full_set(truth, seed, read)
    analysis, true = analyse(as_set(truth, records)), truth_of(truth, records, read.bits)
    found = {name: (one.value, one.deviation) for name, one in found_quantities(analysis).items()}
    z = {name: (found[name][0] - value) / abs(found[name][1]) for name, value in true.items()}
    return z | {f"static {name}": (value - true[name]) / error for name, value, error in _static(analysis)}


def _static(analysis: Analysis) -> Iterator[tuple[str, float, float]]:
    s = analysis.static
    named = {
        "zero_shift": s.zero_shift,
        "dead_space": s.dead_space,
        "hysteresis": s.hysteresis,
        "kp": s.slope,
        "friction": s.friction,
    }
    return ((name, one.value, one.deviation) for name, one in named.items())


def row(name: str, z: Sequence[float]) -> str:
    """RMS, mean and number of z of a quantity."""
    return f"| {name} | {np.sqrt(np.mean(np.square(z))):.2f} | {np.mean(z):+.2f} | {len(z)} |"


def instruments_of(seed: int) -> reference.Instruments:
    """One of the eight, in turn."""
    return INSTRUMENTS[seed % len(INSTRUMENTS)]


def main(seeds: int = 100, first: int = 800) -> None:
    """Print the rows of the table: actuators from a first number on, each with one of the instruments."""
    found = [wrong(seed, instruments_of(seed)) for seed in range(first, first + seeds)]
    for name in found[0]:
        print(row(name, [one[name] for one in found]))


if __name__ == "__main__":
    main(*(int(number) for number in sys.argv[1:]))
