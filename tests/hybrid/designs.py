"""Plants as the program sees them, and designs of them as the independent reference takes them."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ident.hybrid.loop_shaping import design
from ident.hybrid.target_loop import QIAN2014_TARGET
from ident.linear import LinearModel
from ident.presets import preset
from tests.reference import controlled_loop_reference as reference

RATE = 4096.0
IMPLIED = (17.7 - 4.25, 64e3)
"""Mass (kg) and stiffness (N/m) of the specimen that eq. (20) implies: 17.7 kg move."""
STATED = (8.75, 17.5e3)
"""Those of the text: 13.0 kg move."""


def qian(specimen, gain=2.0, **changed):
    """The program's servo loop at Table 4."""
    chain = preset("qian2014").chain
    conditions = {"mL": specimen[0], "k": specimen[1], "cL": 0.0, "Kp": gain, "A": reference.AREA}
    known = {**reference.TABLE_4, **conditions, **changed}
    return chain.linearise({name: known[name] for name in chain.symbols})


def as_model(plant):
    """A plant of the reference as the program's linear model."""
    A, B, C = plant
    return LinearModel.of(A, B, C, np.array(0.0))


def matrices(controller):
    """A controller as the reference takes it."""
    return controller.A, controller.B, controller.C, controller.D


@lru_cache(maxsize=8)
def designed(specimen, structure):
    """A design for Qian's actuator with one sample of delay."""
    return design(qian(specimen), RATE, 1, QIAN2014_TARGET, structure)


@lru_cache(maxsize=8)
def measured(specimen, structure):
    """(f, T, S, N) of the reference, of a design's controller."""
    plant = reference.servo_loop(*specimen, 2.0)
    return reference.responses(plant, matrices(designed(specimen, structure).controller), 1)


def decibel(response):
    """20 lg |·|."""
    return 20 * np.log10(np.abs(response))


def degrees(response):
    """The phase, unwrapped from standstill."""
    return np.degrees(np.unwrap(np.angle(response)))
