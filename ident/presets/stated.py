"""What a model needs to be told of the actuator."""

from collections.abc import Iterable

from ident.errors import Unusable
from ident.matrix import Matrix

_STATED = {"piston_area": "missing-area", "supply_pressure": "missing-supply"}
"""What a model may need of the actuator, and the code of its refusal."""


def refuse_unstated(needs: Iterable[str], matrix: Matrix) -> None:
    """Raise Unusable for what a model needs of the actuator that is neither stated nor measured in every run."""
    for what in needs:
        measured = all(what in run.channels for run in matrix.runs)
        if getattr(matrix.actuator, what) is None and not measured:
            said = what.replace("_", " ")
            raise Unusable(_STATED[what], f"the {said} is not known", f"actuator.{what}", "state it, with its unit")
