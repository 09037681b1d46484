"""The linear model of one run."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ident.chain import Chain, LinearModel, conditions
from ident.matrix import Actuator, Run


def linear_model(chain: Chain, values: Mapping[str, float], run: Run, actuator: Actuator) -> LinearModel:
    """The linearised chain under the conditions of a run, as a batch of one."""
    known = conditions(run, actuator) | dict(values)
    return chain.linearise({name: np.array([known[name]]) for name in chain.symbols}, run.output)
