"""The inputs of a run at the fine steps of a simulation."""

from __future__ import annotations

from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from ident.chain.chain import DISTURBANCE, FORCE, INPUT, INPUT_RATE
from ident.chain.channels import BESIDE_MEAN, means
from ident.chain.measured_conditions import MEASURED_CONDITIONS, is_measured
from ident.run import DISTURBANCES, Run
from ident.simulation.intersample_command import band_limited
from ident.simulation.kernel.layout import BEYOND
from ident.simulation.periodic_displacement import covered, drift
from ident.slopes import bends, bends_of_way, curvatures, slopes

Array = NDArray[np.float64]
_KEPT = 8  # of a run: a search has models that differ by their steps side by side, each of two inputs or more
_known: WeakKeyDictionary[Run, dict[tuple[str, int, int], Array]] = WeakKeyDictionary()
"""Of each run the inputs that were asked for last: a fit asks for the same one thousands of times."""


def fine(run: Run, name: str, steps: int, before: int) -> Array:
    """An input at the fine steps, with `before` steps in front and two behind; not to be written to.

    Before the record a command is what it was, where that is known. Else it was zero where the run starts at rest, and
    its first value where the run is cut out of a longer test.
    """
    kept, asked = _known.setdefault(run, {}), (name, steps, before)
    found = kept.get(asked)
    if found is None:
        found = _fine(run, name, steps, before)
        for oldest in list(kept)[: max(len(kept) + 1 - _KEPT, 0)]:
            kept.pop(oldest, None)  # another thread may have been there first
        kept[asked] = found
    return found


def _fine(run: Run, channel: str, steps: int, before: int) -> Array:
    if run.hold == "band-limited" and channel == INPUT:
        return _curved(run, steps, before)
    samples = _record(run, channel)
    past = samples[:0] if run.past is None or channel != INPUT else run.past[-(before // steps + 1) :]
    samples = np.concatenate([past, samples])
    held, first = run.hold == "zoh" and channel == INPUT, len(past) * steps
    count = len(samples) * steps if held else (len(samples) - 1) * steps + 1
    lead = max(before - first, 0)  # of the steps in front, those from before anything is known
    whole = np.empty(lead + count + steps + 2)
    whole[:lead], whole[lead + count :] = samples[0], samples[-1]
    fine = whole[lead : lead + count]
    if held:
        fine.reshape(-1, steps)[:] = samples[:, None]
    else:
        between, rise = fine[:-1].reshape(-1, steps), np.diff(samples) / steps if channel != BEYOND else 0.0
        for step in range(steps):
            between[:, step] = samples[:-1] + step * rise
        fine[-1] = samples[-1]
    if not first and channel == INPUT and run.begins == "at rest":
        whole[:lead] = 0.0
    if not first and run.hold != "zoh":
        whole[lead - 1] -= jump_share(np.array(2.0)) * (fine[0] - whole[lead - 1])
    return whole[max(first - before, 0) :]


def _curved(run: Run, steps: int, before: int) -> Array:
    """A band-limited command at the fine steps.

    A kernel draws lines between them, which lose (ω h)²/12 of a sine over steps of h. That is put on between the
    samples, as a twelfth of the second difference, and in its place at the samples, where the command is itself.
    """
    samples = -(-before // steps)
    fine = band_limited(run, np.arange(steps) / steps, samples).ravel()
    bent = np.zeros(len(fine))
    bent[1:-1] = (fine[2:] - 2 * fine[1:-1] + fine[:-2]) / 12 * (steps / max(steps - 1, 1))
    bent[::steps] = 0.0
    behind = np.full(3, run.command[-1])  # of which no sample shows anything
    return np.concatenate([(fine - bent)[samples * steps - before :], behind])


def _record(run: Run, name: str) -> Array:
    """The samples of an input; of the rate of the command, what it is at each."""
    derived = "displacement" in run.channels and "velocity" not in run.channels
    if name == INPUT_RATE:
        if derived:
            return curvatures(run.channels["displacement"]) * run.sample_rate**2
        return slopes(run.command, order=1) * run.sample_rate
    if name == BEYOND:
        if not derived:
            return closed(run.command)
        return bends_of_way(run.channels["displacement"], run.command / run.sample_rate) * run.sample_rate
    if name == FORCE:
        return run.channels["force"]
    if name == DISTURBANCE:  # of a run that says nothing there was none
        return next((run.channels[one] for one in DISTURBANCES if one in run.channels), np.zeros(run.length))
    if name in BESIDE_MEAN:
        record = run.channels.get(BESIDE_MEAN[name])
        return np.zeros(run.length) if record is None else np.asarray(record - means(run)[BESIDE_MEAN[name]])
    for beside, channel, unit in MEASURED_CONDITIONS.values():
        if name == beside:  # of a run that did not measure it, it stays
            known = is_measured(run, channel, unit)
            return np.asarray(run.channels[channel] - run.channels[channel].mean()) if known else np.zeros(run.length)
    return run.command


def closed(speed: Array) -> Array:
    """How much the mean from each sample of a speed (n,) to the next is beyond that of the two, 0 behind the last.

    See :mod:`ident.simulation.periodic_displacement`.
    """
    of_two, by_phase = 0.5 * (speed[1:] + speed[:-1]), covered(speed)
    beyond = bends(speed) if by_phase is None else np.append(by_phase - of_two, 0.0)
    return beyond - drift(speed, of_two + beyond[:-1])


def jump_share(delay: Array) -> Array:
    """How far the value one step before a jump goes the other way, in jumps, (lanes,); `delay` in steps.

    The record is drawn in lines: then those to and from it have, as far as the simulation sees them, which begins
    `delay` before the jump, the area of the jump.
    """
    return np.where(delay < 1, 2 / delay - 1, 1 / (1 + (np.minimum(delay, 2) - 1) * (3 - np.minimum(delay, 2))))
