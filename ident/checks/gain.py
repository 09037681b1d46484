"""Sign and size of the response at the lowest excited frequencies, where a position loop follows its command."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees, log

import numpy as np

from ident.checks.finding import Finding
from ident.checks.response import RELATED, Response, response
from ident.run import Run
from ident.words.message import message

BAND = (0.0, 0.1)  # of the command's power
TURNED = 120.0  # degrees; the loop lags by less than 90 there
LARGE, SMALL = 2.0, 1 / 7  # a closed position loop gives 0.5 to 1.2; stiff specimens and leakage lower it
FACTORS = {
    2.54: [("in", "cm")],
    10.0: [("cm", "mm")],
    25.4: [("in", "mm")],
    100.0: [("m", "cm")],
    1000.0: [("m", "mm")],
}
"""Factors of wrong units, with the two units that each lies between."""
USUAL = 0.8  # gain of a position loop near the lowest frequencies of its band
NEAR = 1.6  # either way; half the distance from 10 to 25.4
NARROW = ("sine", "frequency")  # one frequency, at which a loop may well have turned by 180 degrees


def gain(run: Run, measured: Response | None) -> Iterator[Finding]:
    """Wrong sign, a factor of a wrong unit, or no relation at all between command and displacement."""
    same = run.output == "displacement" and run.units.get("command") == "m"
    if not same or measured is None or run.kind in NARROW:
        return
    lowest = measured.between(*BAND)
    if (coherence := float(measured.coherence[measured.between(0.01, 0.9)].mean())) < RELATED:
        if measured.is_average:
            yield unrelated(run, coherence)
        return
    value = complex(measured.uy[lowest].sum() / measured.uu[lowest].sum())
    turn = degrees(abs(np.angle(value)))
    if turn > TURNED:
        text = message("check.sign", run=run.id, turn=turn, **_where(measured))
        yield Finding.of(run.id, "doubt", "sign", text)
    if not SMALL < abs(value) < LARGE:
        values = {"run": run.id, "ratio": abs(value), **_where(measured)}
        factor = guess(abs(value))
        like = {} if factor is None else {"factor": factor, "units": FACTORS[factor]}
        text = message("check.unit_like", **values, **like) if like else message("check.unit", **values)
        yield Finding.of(run.id, "doubt", "unit", text)


def unrelated(run: Run, coherence: float) -> Finding:
    """The finding for two channels that have nothing to do with each other."""
    return Finding.of(run.id, "doubt", "unrelated", message("check.unrelated", run=run.id, coherence=coherence))


def _where(measured: Response) -> dict[str, float]:
    """The band that was looked at, Hz."""
    return {"low": measured.below(BAND[0]), "high": measured.below(BAND[1])}


def guess(ratio: float) -> float | None:
    """The factor of the wrong unit that makes such a ratio; None where none does."""
    size = ratio / USUAL if ratio > 1 else USUAL / ratio
    factor = min(FACTORS, key=lambda each: abs(log(size / each)))
    return factor if abs(log(size / factor)) < log(NEAR) else None


def force_sign(run: Run) -> Iterator[Finding]:
    """The measured force against the force of the specimen, k x + c v + m a, where both are known."""
    specimen, force = run.specimen, run.channels.get("force")
    if specimen is None or force is None or run.units.get("displacement") != "m" or run.units.get("force") != "N":
        return
    measured = response(run.channels["displacement"], force, run.sample_rate)
    if measured is None or measured.coherence[measured.between(0.01, 0.9)].mean() < RELATED:
        return
    omega = 2 * np.pi * measured.frequency
    needed = specimen.stiffness + 1j * omega * specimen.damping - omega**2 * specimen.mass
    used = measured.between(0.01, 0.9)
    agreement = float(np.real(np.sum((needed.conj() * measured.uy)[used])))
    power = float(np.sum((np.abs(needed) ** 2 * measured.uu)[used]))
    if agreement < -0.3 * power:
        text = message("check.force_sign", run=run.id, ratio=agreement / power)
        yield Finding.of(run.id, "doubt", "force-sign", text)
