"""`servoident verdict`: does an actuator keep to its limits?"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from app.cli.remote import DEFAULT, Server, Token, request, segment


def verdict(
    serial: Annotated[str, typer.Argument(metavar="SERIAL", help="Serial number.")],
    at: Annotated[
        str | None, typer.Option(metavar="QUANTITY", help="Judge at a condition by the laws, such as 60 degC.")
    ] = None,
    over: Annotated[
        str, typer.Option(metavar="CONDITION", help="Which one: temperature, supply_pressure, oil_age or cycles.")
    ] = "temperature",
    server: Server = DEFAULT,
    token: Token = "",
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the verdict as JSON; - is stdout.")] = None,
) -> None:
    """Check the approved set of an actuator against its limits.

    Exit status 1 unless it passes.
    """
    check_target(json)
    path = f"/actuators/{segment(serial)}/verdict"
    found = request(server, token, "GET", path, params={"over": over, "at": at} if at else {}).json()
    if json is not None:
        write_json(found, json)
    if json != STANDARD_OUTPUT:
        print(f"{found['serial']}: {found['verdict']}")
        for reason in found["reasons"]:
            print(f"  {reason}")
    if found["verdict"] != "pass":
        raise typer.Exit(1)
