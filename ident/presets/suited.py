"""Which models a matrix allows by its channels, and which of them is taken where none is named."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Protocol

from ident.errors import Unusable
from ident.matrix import BENCH, MOTIONS
from ident.presets import PRESETS, Preset
from ident.stages import OPENED_BY_COMMAND

_OPEN, _UNLIKELY = 2, 5  # ranks: a command in open loop; a motion that something else may drive


class Described(Protocol):
    """A run, or what is known of one."""

    @property
    def kind(self) -> str:
        """Of its command."""
        ...

    @property
    def output(self) -> str:
        """The channel that a model must reproduce."""
        ...

    @property
    def gain(self) -> float | None:
        """Of the position loop, where it was stated."""
        ...

    @property
    def channels(self) -> Collection[str]:
        """The names of what was recorded."""
        ...

    @property
    def units(self) -> Mapping[str, str]:
        """The SI units of the channels."""
        ...


def suited(runs: Sequence[Described]) -> tuple[Preset, ...]:
    """The models that every run drives and shows, the likeliest first, of equals that with the fewest parameters.

    What is driven by a channel of its own comes first. A position loop is taken for one where command and position
    are lengths alike or a loop gain is stated; else the command opens a valve or drives a motor. Raises Unusable where
    no model has such inputs and outputs.
    """
    found = [preset for preset in PRESETS.values() if all(_allows(preset, run) for run in runs)]
    if not found:
        channels = ", ".join(sorted({name for run in runs for name in run.channels}))
        raise Unusable("no-model", f"no model is driven by and shows what the runs have: {channels}", "channels",
                       "name command and output, or choose a model")  # fmt: skip
    return tuple(sorted(found, key=lambda preset: (_rank(preset, runs), len(preset.parameters))))


def in_question(runs: Sequence[Described]) -> tuple[Preset, ...]:
    """Those of them between which only a fit can decide: one, where the channels say what the machine is."""
    found = suited(runs)
    if _rank(found[0], runs) < _OPEN:
        return found[:1]
    return tuple(preset for preset in found if not preset.chain.reads("Kp"))


def unusual(preset: Preset, runs: Sequence[Described]) -> bool:
    """Whether a machine of this kind moves otherwise as a rule: a motor turns, a cylinder goes along a way."""
    units = {run.units.get(run.output, "1") for run in runs}
    return bool(units <= {"m", "m/s"} and preset.turns)


def _allows(preset: Preset, run: Described) -> bool:
    if preset.kind == "bench" or run.kind in BENCH:
        return preset.kind == "bench" and run.kind in BENCH
    return preset.driven_by in run.channels and run.output in preset.chain.outputs


def _rank(preset: Preset, runs: Sequence[Described]) -> int:
    if preset.driven_by != "command":
        bare = not any("command" in run.channels for run in runs)
        return 0 if bare or preset.driven_by not in MOTIONS else _UNLIKELY
    if preset.chain.reads("Kp"):
        looped = any(run.gain is not None for run in runs) or all(_of_lengths(run) for run in runs)
        return 1 if looped else _UNLIKELY - 1
    return _OPEN if OPENED_BY_COMMAND in preset.chain.stages else _OPEN + 1


def _of_lengths(run: Described) -> bool:
    """Whether command and output could be compared by a controller."""
    return run.units.get("command") == run.units.get("displacement") == "m"
