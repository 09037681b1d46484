"""What a hidden effect of a lab's machine is worth, told by the reference before any trial: nats on runs withheld.

The true structure without the effect is fitted to the records without noise; what it leaves of a run that it never saw,
with the noise of the record on it, is less likely than that noise alone.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from ident.diagnosis.candidate_models import CandidateModels
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.fit.windows import unforeseen
from ident.matrix import Matrix
from ident.workflows import compare, identify
from tests.blind.any_machine import Lab

TRUE = {"lag": "first_order", "loop": "qian2014", "cylinder": "open_valve", "motor": "motor"}
COUNTS = 15.0  # nats: what takes off less is not asked for
_WITHHELD = 2  # runs to fit, each withheld in turn; the third, alike, tells what one of them shows
_COLOUR = 0.6  # of the noise of a lab where it is coloured


def nats(lab: Lab) -> float:
    """N/2 ln(v(e + r) / v(e)): r what the true structure leaves of the third run, e its noise, v what is unforeseen."""
    lab = replace(lab, jitter=0.0)
    sound, noisy = lab.measured(noisy=False), lab.measured()
    fit = identify(sound, Settings(model=TRUE[lab.structure]))
    left = _left(sound, fit)
    noise = noisy.runs[-1].measured - sound.runs[-1].measured
    without, with_it = (unforeseen(_whitened(lab, signal)) for signal in (noise, noise + left))
    return _WITHHELD * len(noise) / 2 * float(np.log(with_it / without))


def _left(sound: Matrix, fit: FitResult) -> NDArray[np.float64]:
    """What the best fit leaves of the last run: over windows only where whole runs leave more.

    Without noise windows take what the model lacks for a disturbance, and begin anew to be rid of it.
    """
    last = compare(sound, fit).runs[-1]
    models = CandidateModels.of(sound, Settings(model=fit.model))
    known = {models.preset.parameter(name).in_equations: value for name, value in fit.values.items()}
    whole = models.converged(models.refit((), known))
    run = models.matrix.runs[-1]
    outputs = whole.fitness.fresh((run,)).outputs(whole.point)
    return min(last.run.measured - last.modelled, run.measured - outputs[run.id], key=lambda left: float(np.std(left)))


def _whitened(lab: Lab, signal: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(lfilter([1.0, -_COLOUR], [1.0], signal)[1:]) if lab.coloured else signal
