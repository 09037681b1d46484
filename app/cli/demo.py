"""`servoident demo`: the service with a simulated actuator that is being identified."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.place import Data, settings
from app.cli.progress import shown
from app.cli.remote import request
from app.cli.serving import LOOPBACK, address, free_port, run
from app.cli.upload import files_of

if TYPE_CHECKING:
    from app.settings import Settings

SERIAL = "DEMO-0001"
SECONDS = 2.0  # of each run: enough to identify it within some seconds


def demo(
    port: Annotated[
        int, typer.Option(min=1, max=65535, help="Port to listen on; another one where it is taken.")
    ] = 8000,
    data: Data = None,
) -> None:
    """Run the service with a simulated actuator, DEMO-0001, that is already being identified.

    Its data are kept apart from those of the service, in a folder `demo` of its own.
    """
    from app.settings import default_data
    from ident.synthesis import simulate_matrix

    host = LOOPBACK
    chosen = settings(data or default_data() / "demo", "", host=host, port=free_port(host, port))
    with tempfile.TemporaryDirectory(prefix="servoident-") as folder:
        matrix = Path(folder) / SERIAL
        with shown() as report:
            simulate_matrix(matrix, seconds=SECONDS, report=report, serial=SERIAL)
        run(chosen, lambda: begin(chosen, matrix))


def begin(chosen: Settings, matrix: Path) -> None:
    """Upload the simulated matrix, queue its identification, print the address."""
    server = address(chosen)
    parts = [("files", (name, path.read_bytes())) for name, path in files_of(matrix)]
    stored = request(server, chosen.token, "POST", "/matrices", files=parts).json()
    request(server, chosen.token, "POST", "/fits", json={"matrix": stored["id"]})
    print(f"{SERIAL} is simulated, not measured; its identification has begun", flush=True)
    print(f"servoident: {server}/?token={chosen.token}  (Ctrl-C stops it)", flush=True)
