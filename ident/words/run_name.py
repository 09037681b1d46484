"""What a run is called in a sentence."""

from __future__ import annotations

import re

_SAYS_RUN = re.compile(r"run(?![a-z])", re.IGNORECASE)


def run_name(run: str, *, begins: bool = False) -> str:
    """ "run A"; "run-3" where the id itself says so, and "the run" where it says no more; `begins` a sentence."""
    name = "the run" if run.lower() == "run" else run if _SAYS_RUN.match(run) else f"run {run}"
    return f"{name[:1].upper()}{name[1:]}" if begins else name


def without_name(text: str, run: str) -> str:
    """What is said of a run, beside its name: "the clock of run A has gaps" → "the clock has gaps"."""
    return text.replace(f" of {run_name(run)}", "", 1).removeprefix(f"{run_name(run)} ")
