"""The stated amplitude against the command that was recorded."""

from __future__ import annotations

from collections.abc import Iterator
from math import log, sqrt

import numpy as np

from ident.checks.finding import Finding
from ident.checks.gain import FACTORS
from ident.run import Run
from ident.words.run_name import run_name

TOLERANCE = 0.1  # 2 s of noise of 0-80 Hz scatter by 4 %, 30 s by 1 %
NEAR = 1.12  # either way, for a factor to be named
OF_A_PEAK = {sqrt(2): "the peak of a sine", 2 * sqrt(2): "the peak-to-peak value of a sine"}
RMS_KINDS = ("blwn", "sweep", "sine", "multisine", "other")  # bench records state the amplitude of their sine


def amplitude(run: Run) -> Iterator[Finding]:
    """An RMS of the command that differs from the stated one by more than TOLERANCE, and what would explain it."""
    if run.amplitude is None or run.kind not in RMS_KINDS or "command" not in run.channels:
        return
    rms = float(np.sqrt(np.mean(run.command**2)))
    found = min(float(run.command.std()), rms, key=lambda each: abs(log(each / run.amplitude)))  # type: ignore[operator]
    if abs(found / run.amplitude - 1) <= TOLERANCE:
        return
    unit = run.units.get("command", "")
    ratio = found / run.amplitude
    code, why = explanation(ratio, run)
    text = (
        f"command of {run_name(run.id)} has an RMS of {found:.4g} {unit} where amplitude states {run.amplitude:.4g} "
        f"{unit} ({ratio:.3g} times){why}; correct amplitude, or the unit or scale of the command"
    )
    yield Finding(run.id, "doubt", code, text)


def explanation(ratio: float, run: Run) -> tuple[str, str]:
    """Code and words for a ratio of found to stated amplitude."""
    size = max(ratio, 1 / ratio)
    for factor, unit in FACTORS.items():
        if abs(log(size / factor)) < log(NEAR):
            return "unit", f", near {factor:g}, as if {unit}"
    for factor, name in OF_A_PEAK.items():
        if run.kind in ("sine", "sweep") and abs(log(ratio * factor)) < log(NEAR):
            return "amplitude", f", as if {name} had been stated"
    return "amplitude", ""
