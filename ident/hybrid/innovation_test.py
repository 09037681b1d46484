"""Whether a first-order loop holds: what the innovations of a tracking filter say of its model.

If the model holds, innovations are white and as large as the filter expects them: the mean of their normalised squares
over n samples lies within 1 ± 1.96 √(2/n) in 95 % of cases. Judged in windows of 512 samples, from the second on.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ident.hybrid import kalman
from ident.words.number import trimmed
from ident.words.percent import percent

_FEW_WINDOWS = 0.2  # of the windows may fail: after a change there are some while the filter finds its way
_FEW_SAMPLES = 0.05  # may be outliers


@dataclass(frozen=True)
class InnovationTest:
    """`holds`, with the reason in words; `nis_mean` over the samples that were taken up, None without any."""

    holds: bool
    reason: str
    nis_mean: float | None
    outliers: int
    changes: int


def innovation_test(state: Any) -> InnovationTest:
    """What the counts in a filter's state say."""
    used, windows, failed = int(state[kalman.USED]), int(state[kalman.WINDOWS]), int(state[kalman.FAILED])
    mean = float(state[kalman.NIS]) / used if used else None
    outliers, changes = int(state[kalman.GATED]), int(state[kalman.REOPENED])

    def judged(holds: bool, reason: str) -> InnovationTest:
        return InnovationTest(holds, reason, mean, outliers, changes)

    if not windows or mean is None:
        return judged(False, f"too few samples for a verdict: at least {2 * kalman.WINDOW} are needed")
    if failed > _FEW_WINDOWS * windows:
        return judged(
            False,
            f"a first-order loop is not valid: in {percent(failed / windows)} of the windows of "
            f"{kalman.WINDOW} samples the innovations are too large or not white. Identify a model of "
            f"higher order",
        )
    if changes > _FEW_WINDOWS * windows:
        return judged(
            False,
            f"the parameters jumped {changes} times in {windows} windows of {kalman.WINDOW} samples: "
            f"no first-order loop is valid over the whole run",
        )
    if outliers > _FEW_SAMPLES * (used + outliers):
        share = percent(outliers / (used + outliers))
        return judged(False, f"{share} of the samples are outliers, beyond the noise of the sensor")
    return judged(
        True, f"the innovations are white and as large as the sensor noise (mean normalised square {trimmed(mean)})"
    )
