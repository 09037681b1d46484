"""How a parameter follows the viscosity of oil, written from the laws themselves, and sets that scatter about it."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

GAS = 8.314462618  # J/(mol K)
COLD, HOT = 253.15, 353.15  # K: −20 to 80 °C
Law = Callable[[float], float]


def walther(viscosity_40: float, viscosity_100: float) -> Law:
    """ASTM D341: log log(ν + 0.7) = A − B log T through the viscosities at 40 and 100 °C, mm²/s."""
    points = [
        (math.log10(t), math.log10(math.log10(v + 0.7))) for t, v in ((313.15, viscosity_40), (373.15, viscosity_100))
    ]
    slope = (points[0][1] - points[1][1]) / (points[1][0] - points[0][0])
    height = points[0][1] + slope * points[0][0]
    return lambda kelvin: 10 ** (10 ** (height - slope * math.log10(kelvin))) - 0.7


def arrhenius(energy: float, at_40: float) -> Law:
    """The law of Arrhenius (Andrade) with an activation energy in J/mol."""
    return lambda kelvin: at_40 * math.exp(energy / GAS * (1 / kelvin - 1 / 313.15))


def drawn_law(rng: np.random.Generator, kind: str) -> Law:
    """A law of an oil and a parameter that is proportional to the viscosity, or to the fluidity."""
    size, power = 10 ** rng.uniform(-12, 4), rng.choice([-1, 1])
    if kind == "Arrhenius":
        own = arrhenius(rng.uniform(20e3, 60e3), 1.0)
    else:
        viscosity = rng.uniform(15, 100)
        own = walther(viscosity, rng.uniform(0.8, 1.2) * viscosity**0.5)
    return lambda kelvin: size * own(kelvin) ** power


def drawn_sets(rng: np.random.Generator, law: Law, count: int, scatter: float) -> tuple[list[float], list[float]]:
    """Temperatures and values of sets that scatter by a share of the value."""
    kelvin = rng.uniform(COLD, HOT, count).tolist()
    return kelvin, [law(one) * (1 + scatter * rng.standard_normal()) for one in kelvin]
