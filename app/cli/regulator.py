"""`servoident whatif FIT.json --regulator …`: the margins of a position loop around a servo-actuator of a bench."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.arguments import split
from app.cli.figure_files import write_figures
from app.cli.output import STANDARD_OUTPUT, write_json

if TYPE_CHECKING:
    from ident.bench.position_loop import PositionLoop
    from ident.fit.result import FitResult
    from ident.rig.regulator import Regulator

FORM = "kp=VALUE,ki=…,sample_time=…,delay=…,limit=…"
OfRegulator = Annotated[
    str | None,
    typer.Option(
        "--regulator",
        metavar=FORM,
        help="Position regulator around a fit of the model kononykhin, in rated currents a metre: margins at each "
        "amplitude. May have units, as kp=8 %/mm.",
    ),
]
Amplitudes = Annotated[
    list[str] | None,
    typer.Option(
        "--amplitude",
        metavar="CURRENT",
        help="Amplitude of the current at the play, of the rated current, as 2 %; may be repeated. Default: 1.5, 3 and "
        "10 times the dead space.",
    ),
]


def regulator_of(text: str) -> Regulator:
    """The regulator from `kp=800, sample_time=2 ms`. Raises Unusable."""
    from ident.errors import Unusable
    from ident.rig.regulator import REGULATOR_UNITS, Regulator
    from ident.units.quantity import parameter_value
    from ident.words.nearest import did_you_mean

    given = {}
    for part in filter(str.strip, text.split(",")):
        name, value = split(part, "--regulator", FORM)
        if name not in REGULATOR_UNITS:
            remedy = did_you_mean(name, REGULATOR_UNITS)
            raise Unusable("bad-option", f"a regulator has no {name!r}", "--regulator", remedy)
        given[name] = parameter_value(value, REGULATOR_UNITS[name], f"--regulator {name}")
    if "kp" not in given:
        raise Unusable("bad-option", "there is no kp", "--regulator", f"write {FORM}")
    return Regulator(**given)


def show_margins(
    fit: FitResult, regulator: str | None, amplitudes: list[str], json: Path | None, out: Path | None
) -> None:
    """Work out, show and write the margins; exit status 1 where the loop is unstable at an amplitude."""
    from app.cli.tables import show
    from ident.bench.position_loop import position_loop
    from ident.errors import Unusable
    from ident.units.quantity import parameter_value

    if regulator is None:
        raise Unusable("bad-option", "no regulator is given", "--amplitude", f"write --regulator {FORM} with it")
    sizes = [parameter_value(one, "1", "--amplitude") for one in amplitudes]
    found: PositionLoop = position_loop(fit, regulator_of(regulator), sizes)
    if json is not None:
        write_json(found.to_json(), json)
    if json != STANDARD_OUTPUT:
        show(found.listings())
    if out is not None:
        write_figures(found, out)
    if found.state == "unstable":
        raise typer.Exit(1)
