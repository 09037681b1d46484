"""Options for a machine at another condition: its parameters moved by their laws over the sets of a file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.spread_option import sets_in

if TYPE_CHECKING:
    from ident.design.at_condition import Moved
    from ident.fit.result import FitResult

At = Annotated[
    str | None,
    typer.Option(
        metavar="QUANTITY",
        help="Condition of the machine, such as 60 degC. Each parameter follows its law over it.",
    ),
]
Over = Annotated[
    str, typer.Option(metavar="NAME", help="Which condition: temperature, supply_pressure, oil_age or cycles.")
]
Sets = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="Parameter sets of the laws, from `servoident query --json FILE`."),
]


def moved_to(fit: FitResult, at: str | None, over: str, sets: Path | None) -> Moved:
    """The fit at the condition that is stated; as it is where none is. Raises Unusable."""
    from ident.design.at_condition import AtCondition, Moved, condition_value
    from ident.errors import Unusable

    if at is None:
        if sets is not None:
            raise Unusable(
                "bad-option", "parameter sets were given, but no condition", "--sets", "write --at '60 degC' with it"
            )
        return Moved(fit, ())
    value = condition_value(over, at)
    if sets is None:
        remedy = "write the sets by `servoident query --json FILE`, and give --sets FILE"
        raise Unusable("bad-option", "a condition was given, but no parameter sets", "--at", remedy)
    return AtCondition(over, value, tuple(sets_in(sets, fit.model)), sets.name).move(fit)
