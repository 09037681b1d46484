"""`servoident demo`: the service with two simulated actuators, a sound one and one with hidden effects."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

import typer

from app.cli.data_options import settings
from app.cli.failures import report
from app.cli.local_service import DEMO
from app.cli.remote import items, request
from app.cli.serving import LOOPBACK, address, free_port, run
from app.cli.upload import files_of

SECONDS = 0.5  # of each run of a small matrix: enough to name what is hidden, within seconds
EARLIER = "DEMO-0001"
"""The sound actuator of data folders that earlier versions made."""


@dataclass(frozen=True)
class Example:
    """A simulated actuator to start with; `hidden` are the strengths, SI, of effects that its model does not know."""

    serial: str
    hidden: Mapping[str, float] = field(default_factory=dict)


SOUND = Example("SIM-0001")
LACKING = Example("SIM-0002", {"dead_zone.half_width": 4e-4, "coulomb_friction.force": 60.0})
EXAMPLES = (SOUND, LACKING)


def demo(
    port: Annotated[
        int, typer.Option(min=1, max=65535, help="Port to listen on. If it is in use, another one is chosen.")
    ] = 8000,
    data: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Data folder. Default: `demo` in that of the service.")
    ] = None,
) -> None:
    """Run the service with two simulated actuators.

    The model of SIM-0001 is complete. The model of SIM-0002 is missing effects. Both are identified at once, and the
    first page shows the next step. The data are in a folder `demo`, apart from those of the service; the next start
    reuses them.
    """
    from app.settings import default_data

    host = LOOPBACK
    chosen = settings(data or default_data() / DEMO, "", host=host, port=free_port(host, port))
    run(chosen, lambda: welcome(address(chosen), chosen.token))


def welcome(server: str, token: str) -> None:
    """Begin, and print the address, also where no actuator could be added."""
    try:
        begin(server, token)
    except Exception as error:
        report(error)
    print(f"servoident: {server}/?token={token}  (Ctrl-C stops it)", flush=True)


def begin(server: str, token: str) -> None:
    """Simulate, upload and queue what is wanted beside the actuators that the service has."""
    there = {str(one["serial"]) for one in items(server, token, "/actuators", {"limit": "200"})}
    added = wanted(there)
    for example in added:
        print(f"simulating {example.serial}; on the first use this takes seconds more", file=sys.stderr, flush=True)
        add(example, server, token)
    print(said(added, there), flush=True)


def wanted(there: Collection[str]) -> tuple[Example, ...]:
    """The examples to add beside the actuators of these serial numbers: none twice, none among a lab's own."""
    known = {*there, SOUND.serial} if EARLIER in there else {*there}
    if there and not known & {example.serial for example in EXAMPLES}:
        return ()
    return tuple(example for example in EXAMPLES if example.serial not in known)


def said(added: Collection[Example], there: Collection[str]) -> str:
    """What `begin` did, in a line."""
    if added:
        names = " and ".join(example.serial for example in added)
        return f"{names}: simulated, not measured, and being identified; the first page says what to do next"
    if any(example.serial in there for example in EXAMPLES):
        return "the simulated actuators are there, as you left them; the first page says what to do next"
    return "this data folder holds other actuators, so no simulated one was added"


def add(example: Example, server: str, token: str) -> None:
    """Upload the simulated matrix of an example and queue its identification."""
    from ident.synthesis.matrix import simulate_matrix

    with tempfile.TemporaryDirectory(prefix="servoident-") as folder:
        matrix = Path(folder) / example.serial
        simulate_matrix(matrix, seconds=SECONDS, effects=example.hidden, serial=example.serial, small=True)
        parts = [("files", (name, path.read_bytes())) for name, path in files_of(matrix)]
    stored = request(server, token, "POST", "/matrices", files=parts).json()
    request(server, token, "POST", "/fits", json={"matrix": stored["id"]})
