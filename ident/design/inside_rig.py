"""Proposed runs inside the limits of the rig: every model in question predicts each, which is made smaller if needed.

The many runs that are weighed are judged by the linear parts of the models, over a short piece of their commands; the
one that is proposed by the whole of them, effects in it, over its whole length.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from ident.design.experiment import Experiment
from ident.design.predicted_peaks import Peaks, UncertainMachine
from ident.design.rival import Rival
from ident.design.spread import USUAL
from ident.errors import Unusable
from ident.rig.limits import RigLimits, Utilisation
from ident.run import Run

AIM, LEAST = 0.98, 0.1
"""Of the tightest limit that a run takes at the most, and of its amplitude that is left of it at the least."""
_LONGER = 1.3
"""Times higher are the peaks of a minute of noise than those of a second."""
_TRIES = 6
AsRun = Callable[[Experiment], Run]


def machines_of(rivals: Sequence[Rival]) -> tuple[UncertainMachine, ...]:
    """The models in question, each parameter ± 20 %."""
    found = []
    for of in rivals:
        names = [parameter.in_equations for parameter in of.preset.parameters]
        widths = {name: USUAL * abs(of.values[name]) for name in names}
        found.append(UncertainMachine(of.preset, of.values, widths, of.matrix.actuator))
    return tuple(found)


def inside_rig(
    experiments: Sequence[Experiment], machines: Sequence[UncertainMachine], limits: RigLimits, as_run: AsRun
) -> list[Experiment]:
    """The runs at amplitudes that stay inside; those that would be left with less than a tenth are left out.

    Raises Unusable, with the factor that would do, where none is left.
    """
    known: dict[tuple[object, ...], Peaks] = {}
    kept: dict[tuple[object, ...], Experiment] = {}
    needed = 0.0
    for one in experiments:
        key = one.specimen, one.gain, one.signal, one.frequency
        if key not in known:
            run = as_run(replace(one, amplitude=_LONGER))
            known[key] = _worst([machine.linear_peaks(run) for machine in machines])
        worst = _tightest(limits, known[key].times(one.amplitude))
        factor = 1.0 if worst is None else min(1.0, AIM / worst.share)
        if not known[key].stable:
            continue
        needed = max(needed, factor)
        if factor >= LEAST:
            smaller = one if factor == 1.0 else replace(one, amplitude=float(f"{factor * one.amplitude:.3g}"))
            kept.setdefault((*key, smaller.amplitude), smaller)
    if not kept:
        remedy = f"at {needed:.3g} times the amplitudes of the matrix" if needed else "at smaller gains"
        raise Unusable(
            "beyond-limits",
            "every run that could be proposed leaves the limits of the rig",
            "rig",
            f"make runs {remedy}, or state wider limits",
        )
    return list(kept.values())


def proposed_inside(
    one: Experiment, machines: Sequence[UncertainMachine], limits: RigLimits, as_run: AsRun
) -> tuple[Experiment, Utilisation | None]:
    """The run that is proposed, made smaller until the models with their effects stay inside; what it takes then."""
    worst = None
    for _ in range(_TRIES):
        worst = _tightest(limits, _worst([machine.peaks(as_run(one)) for machine in machines]))
        if worst is None or not worst.exceeded:
            break
        one = replace(one, amplitude=float(f"{one.amplitude * AIM / worst.share:.3g}"))
    return one, worst


def _worst(peaks: Sequence[Peaks]) -> Peaks:
    """The largest of what several models predict."""
    names = set.intersection(*(set(one.sizes) for one in peaks))
    sizes = {name: max(one.sizes[name] for one in peaks) for name in names}
    return Peaks(sizes, all(one.stable for one in peaks))


def _tightest(limits: RigLimits, peaks: Peaks) -> Utilisation | None:
    found = limits.utilisation(peaks.sizes)
    return found[0] if found else None
