"""The stated amplitude against the command that was recorded."""

from __future__ import annotations

from collections.abc import Iterator
from math import log, sqrt

import numpy as np

from ident.checks.finding import Finding
from ident.checks.gain import FACTORS
from ident.run import Run
from ident.words.message import Message, message

TOLERANCE = 0.1  # 2 s of noise of 0-80 Hz scatter by 4 %, 30 s by 1 %
NEAR = 1.12  # either way, for a factor to be named
OF_A_PEAK = {sqrt(2): "check.amplitude_peak", 2 * sqrt(2): "check.amplitude_peak_to_peak"}
"""Peak and peak-to-peak value of a sine over its RMS, with the message that says that it was stated."""
RMS_KINDS = ("blwn", "sweep", "sine", "multisine", "other")  # bench records state the amplitude of their sine


def amplitude(run: Run) -> Iterator[Finding]:
    """An RMS of the command that differs from the stated one by more than TOLERANCE, and what would explain it."""
    if run.amplitude is None or run.kind not in RMS_KINDS or "command" not in run.channels:
        return
    rms = float(np.sqrt(np.mean(run.command**2)))
    found = min(float(run.command.std()), rms, key=lambda each: abs(log(each / run.amplitude)))  # type: ignore[operator]
    if abs(found / run.amplitude - 1) <= TOLERANCE:
        return
    yield Finding.of(run.id, "doubt", *explanation(found, run.amplitude, run))


def explanation(found: float, stated: float, run: Run) -> tuple[str, Message]:
    """Code and message for an RMS that is not the stated amplitude."""
    ratio = found / stated
    values = {"run": run.id, "rms": found, "stated": stated, "unit": run.units.get("command", ""), "ratio": ratio}
    size = max(ratio, 1 / ratio)
    for factor, units in FACTORS.items():
        if abs(log(size / factor)) < log(NEAR):
            return "unit", message("check.amplitude_unit", **values, factor=factor, units=units)
    for factor, key in OF_A_PEAK.items():
        if run.kind in ("sine", "sweep") and abs(log(ratio * factor)) < log(NEAR):
            return "amplitude", message(key, **values)
    return "amplitude", message("check.amplitude", **values)
