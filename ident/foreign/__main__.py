"""``python -m ident.foreign FORMAT FILE MEMORY SECONDS``: the columns of a file to standard output.

It takes so many bytes of memory and seconds of a processor at most.
"""

from __future__ import annotations

import json
import math
import os
import sys
from importlib import import_module
from typing import Any

import numpy as np

_SAID = ("notices", "aliases")
"""What a parser may say in addition to the columns and their rate."""


def limited(memory: int, seconds: float) -> None:
    """Let this process have no more memory and time of a processor, where the system can see to that."""
    try:
        import resource  # noqa: PLC0415 - not on Windows
    except ImportError:
        return
    resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
    whole = math.ceil(seconds)
    resource.setrlimit(resource.RLIMIT_CPU, (whole, whole + 1))  # the first ends it by SIGXCPU, which tells why


def answer(format_: str, path: str) -> tuple[dict[str, Any], list[Any]]:
    """What is said of the columns, and those of numbers."""
    try:
        parser = import_module(f"ident.foreign.{format_}")
        found = list(parser.columns(path))
        rate = parser.rate(path) if hasattr(parser, "rate") else 0.0
        said = {name: getattr(parser, name)(path) for name in _SAID if hasattr(parser, name)}
    except ModuleNotFoundError as error:
        return {"refused": "not-installed", "what": error.name}, []
    except MemoryError:
        return {"refused": "memory", "what": ""}, []
    except Exception as error:  # whatever a parser meets in a broken file
        return {"refused": "broken", "what": f"{type(error).__name__}: {error}"[:200]}, []
    numbers = [np.asarray(values) for _, _, values in found]
    sound = [values.dtype.kind in "iuf" and values.ndim == 1 for values in numbers]
    entries = [
        {"name": name, "unit": unit, "length": len(values) if fine else None}
        for (name, unit, _), values, fine in zip(found, numbers, sound, strict=True)
    ]
    return {"columns": entries, "rate": rate, **said}, [
        values for values, fine in zip(numbers, sound, strict=True) if fine
    ]


def main() -> None:
    """Write a line of JSON, then the columns of numbers as float64, one after the other."""
    format_, path, memory, seconds = sys.argv[1:]
    limited(int(memory), float(seconds))
    with os.fdopen(os.dup(1), "wb") as out:
        os.dup2(2, 1)  # what a parser prints does not come into the answer
        said, numbers = answer(format_, path)
        out.write(json.dumps(said).encode() + b"\n")
        for values in numbers:
            out.write(values.astype("<f8").tobytes())


main()
