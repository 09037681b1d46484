"""Display units are kept for each account: every browser in which it signs in shows them, and no other account's."""

from __future__ import annotations

from fastapi.testclient import TestClient

from tests.app.access.table import API
from tests.app.access.test_tokens import bearer, new
from tests.running import TOKEN

AT = f"{API}/display-units"
COOKIE = "servoident"


def browser(service: TestClient, token: str) -> dict[str, str]:
    """The cookie of a browser that signs in with a token."""
    answer = service.post("/sign-in", data={"token": token}, headers={"Authorization": ""}, follow_redirects=False)
    secret = answer.cookies[COOKIE]
    service.cookies.clear()
    return {"Authorization": "", "Cookie": f"{COOKIE}={secret}"}


def with_units(headers: dict[str, str], units: str) -> dict[str, str]:
    """The same browser with a choice that an earlier version kept there."""
    return {**headers, "Cookie": f"{headers['Cookie']}; units={units}"}


def in_pounds(service: TestClient, fit: str, headers: dict[str, str]) -> bool:
    return " lb" in service.get(f"/fits/{fit}", headers=headers).text


def test_a_choice_follows_its_account_into_every_browser(service: TestClient, fitted: str) -> None:
    """The cookie of an earlier version counts until the account has chosen, and never for another account."""
    token, other = (new(service, "lab")["token"] for _ in range(2))
    at_the_bench, in_the_office, somebody = (browser(service, one) for one in (token, token, other))
    assert not in_pounds(service, fitted, at_the_bench)
    assert in_pounds(service, fitted, with_units(at_the_bench, "lb"))
    chosen = service.put(AT, json={"units": ["in", "lb", "lb"]}, headers=at_the_bench)
    assert chosen.json() == service.get(AT, headers=bearer(token)).json() == {"units": ["in", "lb"]}
    assert in_pounds(service, fitted, in_the_office)
    assert not in_pounds(service, fitted, somebody)
    assert service.get(AT, headers=somebody).json() == {"units": []}
    assert not in_pounds(service, fitted, bearer(token))  # commands and scripts say their units themselves
    assert service.put(AT, json={"units": []}, headers=in_the_office).json() == {"units": []}
    assert not in_pounds(service, fitted, with_units(at_the_bench, "lb"))


def test_the_start_token_is_an_account_too(service: TestClient, fitted: str) -> None:
    assert service.put(AT, json={"units": ["lb"]}).status_code == 200
    assert in_pounds(service, fitted, browser(service, TOKEN))
    assert service.put(AT, json={"units": []}).status_code == 200
    assert service.get(f"{API}/audit", params={"object": "display-units"}).json()["items"]


def test_units_that_are_none_are_refused_with_the_nearest(service: TestClient) -> None:
    refused = service.put(AT, json={"units": ["bars"]})
    assert (refused.status_code, refused.json()["code"]) == (422, "unknown-display-unit")
    assert "bar" in refused.json()["remedy"]
    assert service.put(AT, json={"units": ["bar", "psi"]}).json()["code"] == "two-display-units"
    assert service.get(AT).json() == {"units": []}
