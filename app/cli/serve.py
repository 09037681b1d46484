"""`servoident serve`: run the service."""

from __future__ import annotations

from typing import Annotated

import typer

from app.cli.data_options import Blobs, Data, Database, Log, settings
from app.cli.report_options import Laboratory, Logo, checked
from app.cli.serving import LOOPBACK, address, run
from ident.errors import Unusable

WebhookHosts = Annotated[
    list[str] | None,
    typer.Option(metavar="HOST", help="Allowed host of webhooks, also HOST:PORT or http://HOST; may be repeated."),
]
KeepRaw = Annotated[
    int | None,
    typer.Option(
        metavar="DAYS", min=1, help="Days after which raw data without an approved fit may be deleted. Default: never."
    ),
]
Rate = Annotated[
    float,
    typer.Option(
        metavar="N", min=0, help="Requests per second of one token, with bursts of ten times as many; 0: no limit."
    ),
]


def serve(
    host: Annotated[
        str, typer.Option(help="Address to listen on. The default is reachable only from this machine.")
    ] = LOOPBACK,
    port: Annotated[int, typer.Option(min=1, max=65535, help="Port to listen on.")] = 8000,
    data: Data = None,
    database: Database = "",
    blobs: Blobs = "",
    executor: Annotated[
        str, typer.Option(metavar="NAME", help="Name of this worker, kept over restarts.")
    ] = "servoident-1",
    reserve: Annotated[
        int, typer.Option(min=0, metavar="MB", help="Free space below which uploads are refused.")
    ] = 256,
    log: Log = "text",
    allow_host: Annotated[
        list[str] | None,
        typer.Option(metavar="HOST", help="Host name by which clients may call the service; may be repeated."),
    ] = None,
    proxy: Annotated[
        list[str] | None,
        typer.Option(metavar="ADDRESS", help="Trusted proxy for X-Forwarded-For and -Proto; may be repeated."),
    ] = None,
    rate: Rate = 100.0,
    webhook_host: WebhookHosts = None,
    keep_raw: KeepRaw = None,
    laboratory: Laboratory = "",
    logo: Logo = None,
) -> None:
    """Run the service: pages, HTTP interface and job queue.

    It prints its address with the start token. SERVOIDENT_TOKEN sets the start token, which has the role admin; without
    it each start draws a new one. Other users get tokens of their own: `servoident token new`.
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
        laboratory=laboratory,
        logo=checked(logo),
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
                "bad-address", f"{text!r} is not an address", "--proxy", "write 10.0.0.7 or 10.0.0.0/24"
            ) from None
    return tuple(texts)
