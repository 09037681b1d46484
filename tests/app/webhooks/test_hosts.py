"""Webhooks reach hosts that were named, exactly as they stand, and no other."""

from __future__ import annotations

import pytest

from app.webhooks.hosts import allowed, origins
from ident.errors import Unusable

NAMED = ("hooks.example", "mes.example:8443", "http://10.0.0.7:8080", "127.0.0.1:9000", "localhost", "[::1]:9000")


@pytest.mark.parametrize(
    "url",
    [
        "https://hooks.example/a?b=c",
        "https://HOOKS.example:443/",
        "https://mes.example:8443",
        "http://10.0.0.7:8080/x",
        "http://127.0.0.1:9000/",
        "https://127.0.0.1:9000/",
        "http://localhost/",
        "http://[::1]:9000/",
    ],
)
def test_a_host_that_was_named_is_reached(url: str) -> None:
    assert allowed(url, NAMED)


@pytest.mark.parametrize(
    "url",
    ["http://hooks.example/", "https://hooks.example:8443/", "https://a.hooks.example/", "https://hooks.example./",
     "https://hooks.example@evil.example/", "https://evil.example/hooks.example", "https://10.0.0.7:8080/",
     "http://10.0.0.8:8080/", "http://169.254.169.254/", "http://127.0.0.1:8000/", "http://2130706433:9000/",
     "http://127.1:9000/", "http://0x7f000001:9000/", "http://[::ffff:127.0.0.1]:9000/", "ftp://hooks.example/",
     "https://hooks.example/#x", "https://me:it@hooks.example/", "//hooks.example", "hooks.example", "https://",
     "https://hooks.example\\@evil.example/", "https://hooks.example/\r\nX: y", "https://hooks。example/x y\x00"],
)  # fmt: skip
def test_no_other_host_is(url: str) -> None:
    """Whatever it looks like: other ports and schemes, numbers that are addresses, names of others in it."""
    with pytest.raises(Unusable) as refused:
        allowed(url, NAMED)
    assert refused.value.code in ("host-not-named", "bad-url")


@pytest.mark.parametrize("named", ["https://a/b", "*", "a b", "", "ftp://a", "10.0.0.0/8", "a@b"])
def test_what_is_no_host_cannot_be_named(named: str) -> None:
    with pytest.raises(Unusable) as refused:
        assert not origins([named])
    assert refused.value.code in ("bad-host", "bad-url")
