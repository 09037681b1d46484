"""What the command did before the rows that a run takes of its file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ident.errors import Unusable
from ident.readers.clock import evened
from ident.readers.run_description import RunDescription
from ident.readers.table import Array
from ident.run import Run, Samples
from ident.words.run_name import run_name


def with_past(run: Run, raw: Mapping[str, Array], described: RunDescription, largest: float) -> Run:
    """The run with the command before its first row, as far back as the run is long and no sample is missing.

    On the clock of the run, which counts back from its first sample. `raw` are the columns of the whole file; a sample
    beyond `largest` (SI) is none.
    """
    if described.rows is None or not described.rows[0] or "command" not in raw:
        return run
    (first, end), scale = described.rows, described.channels["command"].scale
    before = slice(max(2 * first - end, 0), first + 1)  # the run's first sample too: what a clock counts back from
    with np.errstate(all="ignore"):
        command: Samples = raw["command"][before].astype(np.float64) * scale.factor + scale.offset
        sound = np.abs(command) < largest
        time = None
        if described.time is not None:
            time = raw["time"][before].astype(np.float64) * described.time.factor
            sound[:-1] &= np.diff(time) > 0
    since = np.flatnonzero(~sound[:-1])
    known = slice(since[-1] + 1 if len(since) else 0, None)
    command, time = command[known], None if time is None else time[known]
    if not run.evened or time is None:
        return replace(run, past=command[:-1]) if len(command) > 1 else run
    count = int((time[-1] - time[0]) * run.sample_rate)
    begin = float(time[-1]) - count / run.sample_rate
    try:
        past = evened(time, command, run.sample_rate, run.hold == "zoh", f"{run_name(run.id)} rows", begin)
    except Unusable:  # hardly any samples, or far apart
        return run
    return replace(run, past=past[:count])
