"""The hosts that webhooks may reach: those that the operator named, each exactly as it stands, and no other.

`HOST` or `HOST:PORT` is reached by https, a loopback address also by http; `http://HOST:PORT` is named for plain http.
There are no wildcards and no networks: a private address is reached where it is named, or by a name that was.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from ipaddress import ip_address

import httpx

from ident.errors import Unusable

_HOST = re.compile(r"[a-z0-9][a-z0-9.-]*|[0-9a-f:.]*:[0-9a-f:.]*")
_PORTS = {"https": 443, "http": 80}
_REMEDY = "write HOST, HOST:PORT, or http://HOST:PORT for plain http"


def origins(named: Iterable[str]) -> frozenset[str]:
    """Scheme, host and port of everything that is named. Raises Unusable."""
    return frozenset(origin for text in named for origin in _origins(text))


def _origins(text: str) -> list[str]:
    schemes = [text.partition("://")[0]] if "://" in text else ["https", "http"]
    found = [_read(f"{scheme}://{text.partition('://')[2] or text}", "--webhook-host", _REMEDY) for scheme in schemes]
    if any(url.path not in ("", "/") or url.query for url in found):
        raise Unusable("bad-host", f"{text!r} is more than a host", "--webhook-host", _REMEDY)
    return [origin_of(url) for url in found if len(schemes) == 1 or url.scheme == "https" or _is_loopback(url.host)]


def allowed(url: str, named: Iterable[str]) -> str:
    """Scheme, host and port of an address that may be reached. Raises Unusable where it may not."""
    found = _read(url, "url", "write https://HOST/PATH")
    origin = origin_of(found)
    if origin not in origins(named):
        raise Unusable(
            "host-not-named",
            f"{origin} is no host that webhooks may reach",
            "url",
            "start the service with --webhook-host and this host",
        )
    return origin


def _read(text: str, where: str, remedy: str) -> httpx.URL:
    """An address as it will be asked for. Raises Unusable."""
    try:
        url = httpx.URL(text)
    except (httpx.InvalidURL, UnicodeError):
        raise Unusable("bad-url", f"{text[:200]!r} is not an address", where, remedy) from None
    plain = _HOST.fullmatch(url.raw_host.decode()) and not url.userinfo and not url.fragment and text.isprintable()
    if url.scheme not in _PORTS or not plain:
        raise Unusable("bad-url", f"{text[:200]!r} is not a plain http or https address", where, remedy)
    return url


def origin_of(url: httpx.URL) -> str:
    """Scheme, host and port."""
    host = url.raw_host.decode()
    return f"{url.scheme}://{f'[{host}]' if ':' in host else host}:{url.port or _PORTS[url.scheme]}"


def _is_loopback(host: str) -> bool:
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"
