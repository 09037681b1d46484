"""What the equations of a chain may read of a run and of its actuator."""

from __future__ import annotations

from weakref import WeakKeyDictionary

from ident.chain.channels import means
from ident.matrix import Actuator
from ident.run import Run, Specimen
from ident.stages import Quantity

CONDITIONS = {
    "Kp": Quantity("Kp", "1", "gain of the position loop, a dial"),
    "mL": Quantity("mL", "kg", "mass of the specimen"),
    "k": Quantity("k", "N/m", "stiffness of the specimen"),
    "cL": Quantity("cL", "N*s/m", "damping of the specimen"),
    "A": Quantity("A", "m^2", "piston area"),
    "Ir": Quantity("Ir", "1", "rated current, in the unit of the record"),
    "Ps": Quantity("Ps", "Pa", "supply pressure, its mean where it was measured"),
    "Nv": Quantity("Nv", "N", "vertical load, its mean where it was measured"),
}
"""What an equation may read of a run and its actuator."""
NEVER = 1e12
"""Pa: a supply pressure that limits nothing."""

_known: WeakKeyDictionary[Run, tuple[Actuator, dict[str, float]]] = WeakKeyDictionary()
"""Of each run those that were asked for last: a fit asks for the same ones before each simulation."""


def conditions(run: Run, actuator: Actuator) -> dict[str, float]:
    """The values of :data:`CONDITIONS` for a run, and the means of its channels.

    Without a stated area A = 1 m²: every parameter that is divided by A² in the model is then that ratio. Without a
    stated rated current 1, without a supply pressure, measured or stated, one that never limits.
    """
    known = _known.get(run)
    if known is None or known[0] is not actuator:
        known = _known[run] = actuator, _conditions(run, actuator)
    return dict(known[1])


def _conditions(run: Run, actuator: Actuator) -> dict[str, float]:
    specimen = run.specimen or Specimen()
    area = 1.0 if actuator.piston_area is None else actuator.piston_area
    supply = _mean(run, "supply_pressure", "Pa") or actuator.supply_pressure or NEVER
    return {
        "Kp": run.Kp,
        "mL": specimen.mass,
        "k": specimen.stiffness,
        "cL": specimen.damping,
        "A": area,
        "Ir": run.rated_current or 1.0,
        "Ps": supply,
        "Nv": _mean(run, "vertical_load", "N"),
        **means(run),
    }


def _mean(run: Run, channel: str, unit: str) -> float:
    """Of a channel in its unit; 0 where it was not measured."""
    return means(run)[channel] if run.units.get(channel) == unit else 0.0


def zeros(run: Run, actuator: Actuator) -> frozenset[str]:
    """The conditions that are 0 for a run: without a spring, say, less of the chain is to be seen."""
    return frozenset(name for name, value in conditions(run, actuator).items() if value == 0)
