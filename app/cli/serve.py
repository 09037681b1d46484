"""`servoident serve`: run the service."""

from __future__ import annotations

from typing import Annotated

import typer

from app.cli.data_options import Blobs, Data, Database, Log, settings
from app.cli.serving import LOOPBACK, address, run
from ident.errors import Unusable

WebhookHosts = Annotated[
    list[str] | None,
    typer.Option(metavar="HOST", help="Host that webhooks may reach, HOST:PORT or http://HOST too; may be repeated."),
]
KeepRaw = Annotated[
    int | None,
    typer.Option(metavar="DAYS", min=1, help="Raw runs that no set in force needs may go after that; else never."),
]
Rate = Annotated[
    float,
    typer.Option(metavar="N", min=0, help="Requests a second of one token, ten times as many at once; 0 is no limit."),
]


def serve(
    host: Annotated[
        str, typer.Option(help="Address to listen on; by default only this machine can reach it.")
    ] = LOOPBACK,
    port: Annotated[int, typer.Option(min=1, max=65535, help="Port to listen on.")] = 8000,
    data: Data = None,
    database: Database = "",
    blobs: Blobs = "",
    executor: Annotated[
        str, typer.Option(metavar="NAME", help="Its own name among those that work on the queue, kept over restarts.")
    ] = "servoident-1",
    reserve: Annotated[
        int, typer.Option(min=0, metavar="MB", help="Free space below which uploads are refused.")
    ] = 256,
    log: Log = "text",
    allow_host: Annotated[
        list[str] | None, typer.Option(metavar="HOST", help="Name under which clients may call it; may be repeated.")
    ] = None,
    proxy: Annotated[
        list[str] | None,
        typer.Option(metavar="ADDRESS", help="A proxy whose X-Forwarded-For and -Proto are believed; may be repeated."),
    ] = None,
    rate: Rate = 100.0,
    webhook_host: WebhookHosts = None,
    keep_raw: KeepRaw = None,
) -> None:
    """Run the service: pages, HTTP interface and job queue. It prints its address with the start token.

    SERVOIDENT_TOKEN sets the start token, which is the admin's; else each start draws a new one. Others use tokens of
    their own: `servoident token new`.
    """
    names = [*(allow_host or []), f"[{host}]" if ":" in host else host]
    allowed = tuple(form for name in names for form in (name, f"{name}:{port}"))
    chosen = settings(
        data,
        database,
        blobs=blobs,
        host=host,
        port=port,
        allowed_hosts=allowed,
        proxies=networks(proxy or []),
        rate=rate,
        executor=executor,
        reserve=reserve << 20,
        log=log,
        webhook_hosts=tuple(webhook_host or []),
        keep_raw=keep_raw,
    )
    run(chosen, lambda: print(f"servoident: {address(chosen)}/?token={chosen.token}  (Ctrl-C stops it)", flush=True))


def networks(texts: list[str]) -> tuple[str, ...]:
    """Addresses and networks of proxies. Raises Unusable."""
    from ipaddress import ip_network

    for text in texts:
        try:
            ip_network(text)
        except ValueError:
            raise Unusable(
                "bad-address", f"{text!r} is no address", "--proxy", "write 10.0.0.7 or 10.0.0.0/24"
            ) from None
    return tuple(texts)
