"""What is exported: the chain of a fit with everything that it moves, its gain and its sample rate stated."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from ident.cached import cached_property
from ident.chain.chain import FORCE, INPUT_RATE, Chain
from ident.chain.conditions import conditions
from ident.custom.definition import preset_with
from ident.effects.effect import off_values
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.matrix import Actuator
from ident.presets import Preset
from ident.run import MOTIONS, Run, Specimen
from ident.simulation.stepper import PackedKernel, packed_kernel
from ident.simulation.steps import fastest_mode, steps_needed

USUAL_RATE = 4096.0
"""Hz: the sample rate of an export that names none."""


@dataclass(frozen=True, eq=False)
class ExportedMachine:
    """A fitted chain under fixed conditions, sampled at `sample_rate` (Hz), its command held between the samples.

    `values` are those of every symbol of the equations, SI; `driven_by` is the channel that is its input; `steps` are
    those into which a sample is divided.
    """

    preset: Preset
    values: Mapping[str, float]
    sample_rate: float
    steps: int

    @property
    def chain(self) -> Chain:
        """The equations."""
        return self.preset.chain

    @property
    def driven_by(self) -> str:
        """The channel that is the input."""
        return self.preset.data.driven_by

    @property
    def outputs(self) -> tuple[str, ...]:
        """The channels that it shows; of those that show one signal the first."""
        first: dict[str, str] = {}
        for channel, signal in self.chain.outputs.items():
            first.setdefault(signal, channel)
        return tuple(first.values())

    def unit(self, channel: str) -> str:
        """The unit of an output channel, SI."""
        return self.chain.units.get(self.chain.outputs[channel], "1")

    @cached_property
    def kernel(self) -> PackedKernel:
        """The kernel that simulates it, with its buffer at rest."""
        lanes = {name: np.array([value]) for name, value in self.values.items()}
        return packed_kernel(self.chain, lanes, self.sample_rate, self.steps, self.outputs)


def exported(
    fit: FitResult,
    specimen: Specimen = Specimen(),  # noqa: B008
    gain: float | None = None,
    sample_rate: float = USUAL_RATE,
) -> ExportedMachine:
    """The machine of a fit with what it moves, its gain Kp (that of the model, or 1) and a sample rate (Hz).

    The current of a bench's actuator is counted in rated currents; without a stated supply pressure none limits it.

    Raises Unusable for one that is driven by more than a held command, conditions that are not above 0, and values
    that are missing.
    """
    preset = preset_with(fit.model, fit.effects, tuple(fit.settings.get("custom", ())))
    _check_driven(fit, preset, specimen)
    for name, value in (("gain", gain), ("sample_rate", sample_rate)):
        if value is not None and not 0 < value < np.inf:
            raise Unusable("out-of-range", f"{name} is {value:g}", "export", "give a number above 0")
    for name, value in vars(specimen).items():
        if not 0 <= value < np.inf:
            raise Unusable("out-of-range", f"{name} is {value:g}", "export", "give 0 or more")
    actuator = fit.actuator or Actuator("")
    if preset.kind == "bench":
        _check_bench(specimen, gain, actuator)
    elif "Ps" in preset.core.symbols and actuator.supply_pressure is None:
        raise Unusable(
            "not-stated",
            "this model depends on the supply pressure",
            "actuator supply_pressure",
            "state it in matrix.yaml and fit again",
        )
    if any(name in fit.parameters for name, _ in (preset.without_area or {}).values()):
        actuator = replace(actuator, piston_area=None)  # the values are ratios to it
    elif preset.kind == "chain" and "A" in preset.chain.symbols and actuator.piston_area is None:
        actuator = replace(actuator, piston_area=preset.search.bounds_hold_for)
    run = Run(
        "export", "", sample_rate, {}, specimen=specimen, gain=preset.data.gains.get("Kp") if gain is None else gain
    )
    known = conditions(run, actuator)
    known |= off_values(preset.effects)
    known |= {preset.parameter(name).in_equations: value for name, value in fit.values.items()}
    if missing := sorted(set(preset.chain.symbols) - known.keys()):
        raise Unusable("bad-fit", f"no value of {', '.join(missing)}", "fit", f"give a fit of model {fit.model}")
    values = {name: known[name] for name in preset.chain.symbols}
    return ExportedMachine(preset, values, sample_rate, _steps(preset, values, sample_rate))


def _check_bench(specimen: Specimen, gain: float | None, actuator: Actuator) -> None:
    """Refuse what the actuator of a bench has not: a loop of its own, a mass, a spring on an unknown area."""
    if gain is not None or specimen.mass or specimen.damping:
        raise Unusable(
            "no-export",
            "an actuator of a bench has no loop, and moves no mass",
            "export",
            "leave gain, mass and damping out",
        )
    if specimen.stiffness and actuator.piston_area is None:
        raise Unusable(
            "not-stated",
            "a spring acts on the piston area",
            "actuator piston_area",
            "state it in matrix.yaml and fit again",
        )


def _check_driven(fit: FitResult, preset: Preset, specimen: Specimen) -> None:
    """Refuse what a file without a record has not: a measured force, and an input that is drawn through its samples."""
    read = frozenset[str]().union(*(equation.names for equation in preset.chain.equations))
    if FORCE in read:
        raise Unusable(
            "no-export",
            "a measured force drives this machine in addition to its command",
            "fit",
            "fit a model whose load is a specimen",
        )
    if fit.settings.get("load") == "force" and specimen == Specimen():
        raise Unusable(
            "not-stated",
            "the load of this fit was the measured force, known for the measured runs only",
            "export",
            "state the specimen that it moves",
        )
    if preset.data.driven_by in MOTIONS and INPUT_RATE in read:
        what = f"the {preset.data.driven_by} is drawn through its samples, and an exported machine holds its input"
        raise Unusable("no-export", what, "fit", "export a machine that a command or a force drives")


def _steps(preset: Preset, values: Mapping[str, float], sample_rate: float) -> int:
    """The steps a sample for commands of any band."""
    known = {name: np.array([value]) for name, value in values.items()}
    fastest = fastest_mode(preset.chain, known, next(iter(preset.chain.outputs))) / sample_rate
    on = [effect for effect in preset.effects if values.get(effect.added[0].in_equations)]
    return int(steps_needed(preset.chain, fastest, "zoh", on, kinks=preset.steps)[0])
