"""The option for what parameters may be off: by hand, or as they scatter between the parameter sets of a file."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from app.cli.arguments import split

if TYPE_CHECKING:
    from ident.design.scatter import Scatter
    from ident.design.spread import Spread

SpreadGiven = Annotated[
    list[str] | None,
    typer.Option(
        "--spread",
        metavar="SHARE|NAME=SHARE|FILE",
        help="Uncertainty of the parameters, such as 20 %, or sets of `servoident query --json FILE`. May be repeated.",
    ),
]
_LARGEST = 50_000_000  # bytes


def spread_in(given: Sequence[str] | None, model: str) -> Spread | Scatter | None:
    """What is stated; None where nothing is, which means the covariance of the fit. Raises Unusable."""
    if not given:
        return None
    files = [Path(text) for text in given if text.endswith(".json")]
    return _scatter(files[0], model) if files else stated_spread(given)


def stated_spread(given: Sequence[str]) -> Spread:
    """A share of every parameter, and of some by name. Raises Unusable."""
    from ident.design.spread import USUAL, Spread
    from ident.units.quantity import parameter_value

    usual, stated = USUAL, {}
    for text in given:
        if "=" in text:
            name, share = split(text, "--spread", "NAME=SHARE")
            stated[name] = parameter_value(share, "1", f"--spread {name}")
        else:
            usual = parameter_value(text, "1", "--spread")
    return Spread(usual, stated)


def _scatter(file: Path, model: str) -> Scatter:
    """Between the sets of a file that are of this model. Raises Unusable."""
    from ident.design.scatter import Scatter

    return Scatter.of_sets(sets_in(file, model), f"{file.name} of model {model}")


def sets_in(file: Path, model: str) -> list[dict[str, float]]:
    """The values of each set of a file that is of this model, by name, SI. Raises Unusable."""
    from ident.errors import Unusable

    if not file.is_file() or file.stat().st_size > _LARGEST:
        raise Unusable(
            "no-such-file", "the file does not exist", str(file), "write it by `servoident query --json FILE`"
        )
    try:
        return [_values(one) for one in json.loads(file.read_bytes()) if one["model"] == model]
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        raise Unusable(
            "bad-sets", "it holds no parameter sets", str(file), "write it by `servoident query --json FILE`"
        ) from None


def _values(one: dict[str, Any]) -> dict[str, float]:
    return {name: float(entry["value"]) for name, entry in one["parameters"].items()}
