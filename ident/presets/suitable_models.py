"""Which models a matrix allows by its channels, and which of them is taken where none is named."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Protocol

import numpy as np

from ident.chain.disturbance import can_be_disturbed
from ident.effects.needs import electric, one_sided
from ident.effects.ringing import resonance
from ident.errors import Unusable
from ident.presets import PRESETS, Preset, preset
from ident.run import BENCH, DISTURBANCES, KINEMATIC, MOTIONS, Run
from ident.stages import OPENED_BY_COMMAND

_STATED, _LOOP, _OTHER_LOOP, _OPEN, _UNLIKELY = 0, 1, 2, 3, 6
"""Ranks: a force, or a motion, by the unit of its command; a loop, and one that is of another drive as a rule; a
command in open loop, or a loop of a speed; a motion of another cause."""
_STRETCHES, _NEAR = 20, 0.1  # of a record whose means are compared; how near they are, a share of the command's
_RESTS, _RESTED = 3, 4  # rests of a command at whose ends an output may have arrived, and samples of one


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


def suitable_models(runs: Sequence[Described], oil: bool = False) -> tuple[Preset, ...]:
    """The models that every run drives and shows, the likeliest first, of equals that with the fewest parameters.

    `oil` is whether parts of a machine with oil are stated (:attr:`ident.matrix.Actuator.states_oil`): without them no
    model of oil is one of an electric drive. What is driven by a channel of its own comes first. A loop is taken for
    one where command and what it compares are lengths or forces alike, or in unknown units but the one where the other
    is, or a loop gain is stated; else the command opens a valve, drives a motor or is a pressure that drives a mass.
    Raises Unusable where no model has such inputs and outputs.
    """
    found = _allowed(runs, oil)
    found = [known for known in found if not known.data.rings or _ring(runs)]
    if not found:
        channels = ", ".join(sorted({name for run in runs for name in run.channels}))
        raise Unusable(
            "no-model",
            f"no model is driven by and shows what the runs have: {channels}",
            "channels",
            "name command and output, or choose a model",
        )
    return tuple(sorted(found, key=lambda known: (_rank(known, runs, oil), len(known.parameters))))


def in_question(runs: Sequence[Described], machine: str = "", oil: bool = False) -> tuple[Preset, ...]:
    """Those of them between which only a fit can decide: one, where the channels say what the machine is.

    A `machine` that the matrix puts together from stages is the only one.
    """
    if machine:
        return (preset(machine),)
    found = suitable_models(runs, oil)
    if _rank(found[0], runs, oil) < _OPEN:
        return found[:1]
    return tuple(known for known in found if not known.chain.reads("Kp") or _rank(known, runs, oil) == _OPEN)


def is_assumed_loop(model: Preset, runs: Sequence[Described]) -> bool:
    """Whether the model is a loop that nobody stated: command and output may be alike though no loop compares them."""
    return model.chain.reads("Kp") and all(run.gain is None for run in runs)


def without_loop(runs: Sequence[Described], oil: bool = False) -> tuple[Preset, ...]:
    """The models in question where nothing compares the output with the command, as on both sides of a gear."""
    return tuple(known for known in suitable_models(runs, oil) if not known.chain.reads("Kp"))


def on_a_spring(models: Collection[Preset], runs: Sequence[Described], oil: bool = False) -> tuple[Preset, ...]:
    """The machines against a spring that are not among the `models` in question, since no record of theirs rings.

    Friction and damping keep a throttle or a valve from ringing. Such a machine is in question where the position
    follows the command, so that what integrates explains less of it than a lag: only fits can tell. A speed does not
    follow against a spring.
    """
    if len(models) == 1 or any(run.output == "velocity" for run in runs):
        return ()
    return tuple(known for known in _allowed(runs, oil) if known.data.rings and known not in models)


def _allowed(runs: Sequence[Described], oil: bool) -> list[Preset]:
    """The models that every run drives and shows; none of oil for an electric drive."""
    without_oil = electric(runs, oil)
    found = [known for known in PRESETS.values() if all(_allows(known, run) for run in runs)]
    return [known for known in found if not (known.chain.has_oil and without_oil)]


def told_by_following(model: Preset, runs: Sequence[Described]) -> bool:
    """Whether only the records themselves, in unknown units, tell that it is a loop."""
    return all(run.gain is None and _follows(run, _compared(model)) for run in runs)


def _compared(model: Preset) -> str:
    """The channel that a loop compares with its command."""
    return model.data.compares or "displacement"


def _follows(run: Described, channel: str) -> bool:
    """Whether a channel ends where the command does, of a record that was read in unknown units.

    Of what follows by a lag, T y' + y = K r, the mean over a stretch of length t is a + K r̄ − T (y₁ − y₀)/t, and a
    loop leaves K = 1 and a = 0.
    """
    if not isinstance(run, Run) or not {"command", channel} <= {*run.channels} or run.length < _STRETCHES:
        return False
    if run.units.get("command") != "1" or run.units.get(channel) != "1":
        return False
    if _arrives(run, channel):
        return True
    r, y = (np.array_split(run.channels[name], _STRETCHES) for name in ("command", channel))
    command, shown = np.array([part.mean() for part in r]), np.array([part.mean() for part in y])
    terms = np.column_stack([command, np.ones(_STRETCHES), [part[-1] - part[0] for part in y]])
    found = np.linalg.lstsq(terms, shown)[0]
    gain, offset, off = found[0], found[1], shown - terms @ found
    apart = abs(offset + (gain - 1) * command.mean())
    near = abs(gain - 1) < _NEAR and apart < _NEAR * np.std(run.command)
    return bool(near and np.std(off) < _NEAR * np.std(command))


def _arrives(run: Run, channel: str) -> bool:
    """Whether a channel is where a command was that rests, at the end of each of several rests.

    However it came there, as slowly as its drive allows: a motor whose voltage is limited does so by no lag.
    """
    command, shown, near = run.command, run.channels[channel], _NEAR * np.std(run.command)
    ends = np.append(np.flatnonzero(np.abs(np.diff(command)) > near), run.length - 1)
    ends = ends[np.diff(ends, prepend=-1) >= _RESTED]  # between rests a sample of an uneven clock is of both
    return len(ends) >= _RESTS and bool(np.max(np.abs(shown[ends] - command[ends])) < near)


def unusual(model: Preset, runs: Sequence[Described]) -> bool:
    """Whether a machine of this kind moves otherwise as a rule: a motor turns, a cylinder goes along a way.

    Of a speed alone nothing tells them apart. A motor is then a lag with a mass, on which friction and springs act. An
    angle opens no valve: it tilts a beam or turns a drum, and what it moves along a way is no cylinder's either.
    """
    units = {run.units.get(run.output, "1") for run in runs}
    tilted = all(run.units.get("command") == "rad" for run in runs)
    return bool(units <= {"m"} and model.data.turns and not tilted)


def has_no_parts(model: Preset) -> bool:
    """Whether a model is no machine, but says how one follows its command: that makes nothing flow or push."""
    stages = model.chain.stages
    return OPENED_BY_COMMAND in stages and not any(stage.place in ("flow", "pressure") for stage in stages)


def _allows(model: Preset, run: Described) -> bool:
    if model.kind == "bench" or run.kind in BENCH:
        return model.kind == "bench" and run.kind in BENCH
    disturbed = [DISTURBANCES[name] for name in run.channels if name in DISTURBANCES]
    if not all(can_be_disturbed(model.chain, place) for place in disturbed):
        return False
    if model.data.one_sided and not _one_sided(run):
        return False
    if model.data.command_units and run.units.get("command") not in model.data.command_units:
        return False
    drives = {model.data.driven_by} | ({"displacement"} if model.data.driven_by == "velocity" else set())
    drives |= {"command"} if _by_force(model, run) or _by_motion(model, run) else set()
    return bool(drives & set(run.channels)) and run.output in model.chain.outputs and run.output not in drives


def _ring(runs: Sequence[Described]) -> bool:
    """Whether runs that were read answer their commands with a damped oscillation."""
    read = [run for run in runs if isinstance(run, Run) and run.output in run.channels]
    return resonance([run for run in read if run.use == "fit"] or read) is not None


def _one_sided(run: Described) -> bool:
    """Whether a run that was read shows a command and an output that stay on one side of zero."""
    if not isinstance(run, Run) or not {"command", run.output} <= {*run.channels}:
        return False
    return one_sided(run.command) and one_sided(run.measured)


def _rank(model: Preset, runs: Sequence[Described], oil: bool) -> int:
    if any(_by_force(model, run) for run in runs):
        stated = all(run.units.get("command") != "1" and run.output in KINEMATIC for run in runs)
        return _STATED if stated else _OPEN  # what is in units of 1 may be no force, and an output what follows one
    if "m/s^2" in model.data.command_units:
        return _STATED  # an acceleration is the command of nothing but a base
    if all(_by_motion(model, run) for run in runs):
        return _STATED if moved_by_command(model, runs) else _OPEN
    if model.data.driven_by != "command":
        bare = not any("command" in run.channels for run in runs)
        return 0 if bare or model.data.driven_by not in MOTIONS else _UNLIKELY
    if model.data.compares or model.chain.reads("Kp"):
        compared = _compared(model)
        looped = any(run.gain is not None for run in runs) and compared in {run.output for run in runs}
        looped = looped or all(_comparable(run, compared) for run in runs)
        if compared == "velocity":
            usual = _OPEN  # a drive without a loop may be scaled so that its speed is nearly the commanded one
        else:
            usual = _LOOP if electric(runs, oil) or not model.data.turns else _OTHER_LOOP
        return usual if looped else _UNLIKELY - 1
    return _OPEN if OPENED_BY_COMMAND in model.chain.stages and not has_no_parts(model) else _OPEN + 1


def _by_force(model: Preset, run: Described) -> bool:
    """Whether a drive's force may be what was recorded as the command: by its unit, or before a force for that is not
    known.

    Of a motion, a motor makes the force of a command in an unknown unit: its drive may be late, or have a dead zone.
    """
    unit = run.units.get("command")
    is_force = unit in ("N", "N*m") or (unit == "1" and run.output == "force")
    return model.data.driven_by == "drive_force" and is_force and "drive_force" not in run.channels


def _by_motion(model: Preset, run: Described) -> bool:
    """Whether the motion that drives a specimen may be what was recorded as the command."""
    return model.data.driven_by == "velocity" and isinstance(run, Run) and bool(run.commanded_motion)


def moved_by_command(model: Preset, runs: Sequence[Described]) -> bool:
    """Whether the command of every run is the motion of a specimen, by its unit."""
    return all(_by_motion(model, run) and run.units["command"] != "1" for run in runs)


def _comparable(run: Described, channel: str) -> bool:
    """Whether a controller could compare the command with a channel, or with a position that nobody recorded beside an
    acceleration, as of a shaking table."""
    units = {"displacement": ("m", "rad"), "velocity": ("m/s", "rad/s"), "force": ("N", "N*m")}
    unit = run.units.get("command")
    shown = (f"{unit}/s^2", "acceleration") if _only_shaken(run, channel) else (unit, channel)
    return (unit in units[channel] and shown[0] == run.units.get(shown[1])) or _follows(run, channel)


def _only_shaken(run: Described, channel: str) -> bool:
    """Whether an acceleration alone shows the position that is commanded."""
    return channel == "displacement" and channel not in run.channels and run.output == "acceleration"
