"""Which models a matrix allows by its channels, and which of them is taken where none is named."""

from __future__ import annotations

from ident.errors import Unusable
from ident.matrix import BENCH, MOTIONS, Matrix, Run
from ident.presets import PRESETS, Preset
from ident.stages import OPENED_BY_COMMAND


def suited(matrix: Matrix) -> tuple[Preset, ...]:
    """The models that every run drives and shows, the likeliest first, of equals that with the fewest parameters.

    What is driven by a channel of its own comes first. A position loop is taken for one where command and position
    are lengths alike or a loop gain is stated; else the command opens a valve or drives a motor. Raises Unusable where
    no model has such inputs and outputs.
    """
    found = [preset for preset in PRESETS.values() if all(_allows(preset, run) for run in matrix.runs)]
    if not found:
        channels = ", ".join(sorted({name for run in matrix.runs for name in run.channels}))
        raise Unusable("no-model", f"no model is driven by and shows what the runs have: {channels}", "channels",
                       "name command and output, or choose a model")  # fmt: skip
    looped = any(run.gain is not None for run in matrix.runs) or all(_of_lengths(run) for run in matrix.runs)
    bare = not any("command" in run.channels for run in matrix.runs)
    return tuple(sorted(found, key=lambda preset: (_rank(preset, looped, bare), len(preset.parameters))))


def why(preset: Preset, matrix: Matrix) -> str:
    """In a sentence, why a model is taken where none is named."""
    shown = " and ".join(dict.fromkeys(run.output for run in matrix.runs))
    others = [other.name for other in suited(matrix) if other is not preset]
    beside = f"; {' and '.join(others)} would take these channels too (--model)" if others else ""
    return f"No model was named: {preset.name} is driven by {preset.driven_by} and shows {shown}{beside}."


def _allows(preset: Preset, run: Run) -> bool:
    if preset.kind == "bench" or run.kind in BENCH:
        return preset.kind == "bench" and run.kind in BENCH
    return preset.driven_by in run.channels and run.output in preset.chain.outputs


def _rank(preset: Preset, looped: bool, commandless: bool) -> int:
    if preset.driven_by != "command":
        return 0 if commandless or preset.driven_by not in MOTIONS else 5
    if preset.chain.reads("Kp"):
        return 1 if looped else 3
    return 2 if OPENED_BY_COMMAND in preset.chain.stages else 4


def _of_lengths(run: Run) -> bool:
    """Whether command and output could be compared by a controller."""
    return run.units.get("command") == run.units.get("displacement") == "m"
