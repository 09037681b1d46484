"""`servoident serve`: run the service."""

from __future__ import annotations

from typing import Annotated

import typer

from app.cli.data_options import Data, Database, settings
from app.cli.serving import LOOPBACK, address, run


def serve(
    host: Annotated[
        str, typer.Option(help="Address to listen on; by default only this machine can reach it.")
    ] = LOOPBACK,
    port: Annotated[int, typer.Option(min=1, max=65535, help="Port to listen on.")] = 8000,
    data: Data = None,
    database: Database = "",
    allow_host: Annotated[
        list[str] | None, typer.Option(metavar="HOST", help="Name under which clients may call it; may be repeated.")
    ] = None,
) -> None:
    """Run the service: pages, HTTP interface and job queue. It prints its address with the start token.

    SERVOIDENT_TOKEN sets the token; else each start draws a new one.
    """
    names = [*(allow_host or []), f"[{host}]" if ":" in host else host]
    allowed = tuple(form for name in names for form in (name, f"{name}:{port}"))
    chosen = settings(data, database, host=host, port=port, allowed_hosts=allowed)
    run(chosen, lambda: print(f"servoident: {address(chosen)}/?token={chosen.token}  (Ctrl-C stops it)", flush=True))
