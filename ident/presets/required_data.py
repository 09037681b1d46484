"""What a model needs of a matrix: what drives it, what must be stated, what runs may leave open."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from ident.errors import Unusable
from ident.matrix import Matrix
from ident.presets.convention import Convention

_STATED = {"piston_area": "missing-area", "supply_pressure": "missing-supply"}
"""What a model may need of the actuator, and the code of its refusal."""


@dataclass(frozen=True)
class RequiredData:
    """What must be measured or stated, and what holds where it is not."""

    driven_by: str = "command"
    """Channel that drives the model; the command where a run has none of that name."""
    command_units: tuple[str, ...] = ()
    """SI units of a command that drives such a machine; () for any."""
    area: str = ""
    """Parameter that is the stated piston area, where the motion is one along a way."""
    compares: str = ""
    """Channel that its controller compares with the command; "" where there is no controller."""
    gains: Mapping[str, float] = field(default_factory=dict)
    """Gains of the controller that are known, and a stated area; Kp is that of runs that state none."""
    alone: bool = False
    """Whether a run that states no specimen moves none."""
    turns: bool = False
    """Whether the motion of such a machine is an angle as a rule."""
    one_sided: bool = False
    """Whether command and output of such a machine stay on one side of zero, as a pump and a level do."""
    rings: bool = False
    """Whether such a machine is in question from the start where its records answer their commands with a damped
    oscillation; elsewhere where a lag explains more of them than what integrates."""
    needs: tuple[str, ...] = ()
    """What must be stated of the actuator, or measured."""
    conventions: tuple[Convention, ...] = ()
    """What runs may leave open, and the values that are then held."""
    share_force: tuple[str, ...] = ()
    """Parameters that one factor for all leaves without a trace while no force is known: the first is then held."""


def refuse_unstated(needs: Iterable[str], matrix: Matrix) -> None:
    """Raise Unusable for what a model needs of the actuator that is neither stated nor measured in every run."""
    for what in needs:
        measured = all(what in run.channels for run in matrix.runs)
        if getattr(matrix.actuator, what) is None and not measured:
            said = what.replace("_", " ")
            raise Unusable(_STATED[what], f"the {said} is not known", f"actuator.{what}", "state it, with its unit")
