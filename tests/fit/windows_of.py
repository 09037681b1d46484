"""Small records for tests of windows, offsets and first states."""

from __future__ import annotations

import numpy as np

from ident.run import Run


def record(name: str, measured: np.ndarray, output: str = "displacement", rate: float = 1000.0) -> Run:
    """A run of this output under a command that is zero at first."""
    command = np.append(np.zeros(len(measured) // 2), np.ones(len(measured) - len(measured) // 2))
    return Run(name, "", rate, {"command": command, output: measured}, {output: "m"}, output=output)
