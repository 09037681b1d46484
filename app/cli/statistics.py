"""`servoident statistics`: what the sets of a batch, or of an actuator over time, tell about production."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from app.cli.output import STANDARD_OUTPUT, check_target, write_bytes, write_json
from app.cli.remote import DEFAULT, Server, Token, request


def statistics(
    parameter: Annotated[str, typer.Argument(metavar="PARAMETER", help="Parameter name, or error.fit, error.verify.")],
    batch: Annotated[str | None, typer.Option(help="Batch.")] = None,
    serial: Annotated[str | None, typer.Option(help="Serial number: show its history of approved sets.")] = None,
    model: Annotated[str | None, typer.Option(help="Model.")] = None,
    server: Server = DEFAULT,
    token: Token = "",
    json: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write the statistics as JSON; - is stdout.")
    ] = None,
    figure: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Draw the control chart, or the law: .svg, .png, .pdf or .json."),
    ] = None,
    over: Annotated[
        str | None,
        typer.Option(
            metavar="CONDITION", help="Show the law over temperature, supply_pressure, oil_age or cycles instead."
        ),
    ] = None,
    at: Annotated[str | None, typer.Option(metavar="QUANTITY", help="Value of the condition, such as 60 degC.")] = None,
) -> None:
    """Show statistics of a parameter over the approved sets.

    They include spread, control chart, Cpk, outliers and drift. With --over: how it depends on a condition of the
    tests.
    """
    check_target(json)
    check_target(figure)
    given = {"parameter": parameter, "batch": batch, "serial": serial, "model": model}
    params = {name: value for name, value in given.items() if value is not None}
    of_law = over is not None or at is not None
    asked = params | ({"over": over or "temperature"} | ({"at": at} if at else {}) if of_law else {})
    found = request(server, token, "GET", "/statistics/over" if of_law else "/statistics", params=asked).json()
    if figure is not None:
        name = "dependence" if of_law else "control-chart"
        path = f"/statistics/figures/{name}.{figure.suffix.removeprefix('.') or 'svg'}"
        write_bytes(request(server, token, "GET", path, params=asked).content, figure)
    if json is not None:
        write_json(found, json)
    if json != STANDARD_OUTPUT:
        (show_law if of_law else show)(found)


def show(found: dict[str, Any]) -> None:
    """Print the numbers, then what is out of the ordinary."""
    from app.cli.tables import output, table
    from app.statistics.words import called, facts
    from schemas.statistics import StatisticsView

    view = StatisticsView(**found)
    console = output()
    console.print(table(("of", view.parameter), facts(view), numbers=()))
    rows = [(one.serial, one.fit, one.value, one.why) for one in called(view)]
    if rows:
        console.print(table(("serial", "fit", "value", "out of the ordinary"), rows, numbers=("value",)))


def show_law(found: dict[str, Any]) -> None:
    """Print the law over a condition, those that were tried, and the value at one condition."""
    from app.cli.tables import output, table
    from app.statistics.words import laws, of_dependence
    from schemas.statistics import DependenceView

    view = DependenceView(**found)
    console = output()
    console.print(table(("of", view.parameter), of_dependence(view), numbers=()))
    if view.laws:
        header = ("law", "formula", "probability", "scatter", "lack of fit, p")
        console.print(table(header, laws(view), numbers=header[2:]))
