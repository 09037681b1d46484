"""One table of routes and roles: whoever asks gets what the table says, from every route that there is."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from fastapi.routing import iter_route_contexts
from fastapi.testclient import TestClient
from starlette.routing import WebSocketRoute
from starlette.websockets import WebSocketDisconnect

from app.access.roles import declared
from app.pages.assets import VEGA
from app.tables import TokenRow, before
from tests.app.access.idle import idle, idle_app
from tests.app.access.table import API, EVERY, OF_API, PAGES, SOCKETS, STATIC, Call
from tests.running import TOKEN

CALLS = [*(Call(**{**vars(call), "path": API + call.path}) for call in OF_API), *PAGES, *STATIC]
START = {"Authorization": f"Bearer {TOKEN}"}
NOBODY = {"Authorization": ""}


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[TestClient]:
    """A service that holds nothing, and limits nobody."""
    with idle(tmp_path_factory.mktemp("roles"), rate=0, failures=0) as client:
        yield client


@pytest.fixture(scope="module")
def tokens(service: TestClient) -> dict[str, str]:
    """A token of each role, one that has expired, one that was revoked; and the cookies of sessions."""
    made = {role: new(service, role)["token"] for role in EVERY}
    expired, revoked, left = (new(service, "admin") for _ in range(3))
    with service.app.state.context.sessions.begin() as session:
        session.get(TokenRow, expired["id"]).expires_at = before(timedelta(seconds=1))
    cookies = {name: cookie(service, made[name]) for name in EVERY}
    cookies |= {"left": cookie(service, left["token"]), "of revoked": cookie(service, revoked["token"])}
    assert service.post("/sign-out", headers=as_cookie(cookies["left"]), follow_redirects=False).status_code == 303
    assert service.delete(f"{API}/tokens/{revoked['id']}", headers=START).status_code == 200
    others = f"{cookies['admin'].partition('.')[0]}.{cookies['line'].partition('.')[2]}"
    wrong = {
        "expired": expired["token"],
        "revoked": revoked["token"],
        "guessed": TOKEN + "x",
        "of another": f"{expired['id']}.{made['admin'].partition('.')[2]}",
    }
    return made | wrong | {f"cookie {name}": text for name, text in (cookies | {"of another": others}).items()}


def new(service: TestClient, role: str) -> dict[str, str]:
    answer = service.post(f"{API}/tokens", json={"name": f"a {role}", "role": role}, headers=START)
    assert answer.status_code == 201, answer.text
    made: dict[str, str] = answer.json()
    return made


def cookie(service: TestClient, token: str) -> str:
    """Sign in; what the browser keeps."""
    answer = service.post("/sign-in", data={"token": token}, follow_redirects=False)
    assert answer.status_code == 303
    service.cookies.clear()
    return str(answer.cookies["servoident"])


def as_cookie(text: str) -> dict[str, str]:
    return {"Cookie": f"servoident={text}"}


def asked(service: TestClient, call: Call, headers: dict[str, str]) -> int:
    """The status of an answer to a call whose subject does not exist."""
    path = call.path.replace("{vega}", VEGA.rpartition("/")[2])
    for name in ("matrix", "fit", "job", "diagnosis", "controller", "simulation", "token", "serial", "edition", "path",
                 "draft", "webhook", "plan"):  # fmt: skip
        path = path.replace(f"{{{name}}}", "nothing")
    path = (
        path.replace("/manual/{name}", "/manual/index")
        .replace("{name}", "bode")
        .replace("{kind}", "svg")
        .replace("{place}", "0")
        .replace("{file}/{column}", "0/0")
    )
    service.cookies.clear()
    content: dict[str, Any] = {"data": call.form} if call.form else {"json": []} if call.body is not None else {}
    answer = service.request(call.method, path, headers=headers, follow_redirects=False, **content)
    return answer.status_code


def in_turn(call: Call, turn: int) -> list[str]:
    """One of the roles that may and one of those that may not, where there are such."""
    sides = [[role for role in EVERY if (role in call.roles) is may] for may in (True, False)]
    return [side[turn % len(side)] for side in sides if side]


@pytest.mark.parametrize("call", CALLS, ids=lambda call: call.name)
def test_each_role_may_what_the_table_says(service: TestClient, tokens: dict[str, str], call: Call, full: bool) -> None:
    """By token and by cookie: 403 where the role may not, neither 401 nor 403 nor 5xx where it may.

    In the short form one role that may and one that may not, from route to route in turn; by cookie at every third.
    """
    turn = CALLS.index(call)
    both = full or turn % 3 == 0
    for role in EVERY if full else in_turn(call, turn):
        by_token, by_cookie = {"Authorization": f"Bearer {tokens[role]}"}, as_cookie(tokens[f"cookie {role}"])
        for shown in (by_token, by_cookie) if both else (by_token,):
            if call.path == "/sign-out" and "Cookie" in shown:
                continue  # which would end the session that the next call is made in
            status = asked(service, call, shown)
            if call.form and call.free:
                assert status == 401, "its form held no token"
            elif call.free or role in call.roles:
                assert status not in (401, 403), (role, status)
                assert status < 500, (role, status)
            else:
                assert status == 403, (role, status)


@pytest.mark.parametrize("call", CALLS, ids=lambda call: call.name)
def test_whoever_has_no_valid_token_gets_nothing(
    service: TestClient, tokens: dict[str, str], call: Call, full: bool
) -> None:
    """None, expired, revoked, guessed; of a session that was left, whose token was revoked, or another's id.

    In the short form none, and every third of the others, from route to route in turn.
    """
    bearers = [{"Authorization": f"Bearer {tokens[name]}"} for name in ("expired", "revoked", "guessed", "of another")]
    cookies = [as_cookie(tokens[f"cookie {name}"]) for name in ("left", "of revoked", "of another")]
    wrong = (NOBODY, *bearers, *cookies, as_cookie(TOKEN), as_cookie(tokens["admin"]))
    for shown in ({}, *(wrong if full else wrong[CALLS.index(call) % 3 :: 3])):
        status = asked(service, call, shown)
        assert (status not in (401, 403)) if call.free and call.form == {} else status == 401, (shown, status)


def test_the_table_has_every_route(service: TestClient) -> None:
    """Of the API's document, of the pages, and the sockets; each declares its roles once."""
    document = service.get(f"{API}/openapi.json", headers=START).json()
    documented = {(method.upper(), path) for path, operations in document["paths"].items() for method in operations}
    contexts = list(iter_route_contexts(service.app.routes))
    served = {(method, plain(each.path)) for each in contexts for method in each.methods or ()}
    table = {(call.method, call.path.replace("{vega}", VEGA.rpartition("/")[2])) for call in CALLS}
    assert documented <= table
    assert served == table
    sockets = [each for each in contexts if isinstance(each.original_route, WebSocketRoute)]
    assert [each.path for each in sockets] == list(SOCKETS)
    assert [each.path for each in contexts if declared(each.original_route) is None] == []


def plain(path: str | None) -> str:
    return str(path).replace(":path}", "}")


def test_the_document_says_what_the_table_says(service: TestClient) -> None:
    paths = service.get(f"{API}/openapi.json", headers=START).json()["paths"]
    for call in OF_API:
        if call.path == "/openapi.json":
            continue
        said = [role for each in paths[API + call.path][call.method.lower()]["security"] for role in each["token"]]
        assert sorted(said) == sorted(call.roles), call.name


def test_a_route_without_roles_is_refused_to_all(tmp_path: Path) -> None:
    """Also to the admin; a page, an answer of the API and a socket alike."""
    app = idle_app(tmp_path)

    @app.get("/api/v1/forgotten")
    def forgotten() -> str:
        return "secret"

    @app.websocket("/api/v1/also-forgotten")
    async def also(socket: Any) -> None:
        await socket.accept()

    app.router.routes.sort(key=lambda route: getattr(route, "path", None) is None)  # before the pages' last resort
    client = TestClient(app, "http://127.0.0.1:8000", headers=START)
    answer = client.get("/api/v1/forgotten")
    assert (answer.status_code, answer.json()["code"]) == (403, "no-role")
    with pytest.raises(WebSocketDisconnect), client.websocket_connect("/api/v1/also-forgotten", headers=START):
        pass


def test_the_socket_knows_tokens_and_cookies(service: TestClient, tokens: dict[str, str]) -> None:
    host = {"Host": "127.0.0.1:8000"}

    def opened(shown: dict[str, str]) -> bool:
        try:
            with service.websocket_connect(SOCKETS[0], headers=host | shown):
                return True
        except WebSocketDisconnect:
            return False

    for role in EVERY:
        assert opened({"Authorization": f"Bearer {tokens[role]}"})
        assert opened(as_cookie(tokens[f"cookie {role}"]))
    for name in ("expired", "revoked", "guessed", "of another"):
        assert not opened({"Authorization": f"Bearer {tokens[name]}"})
    for name in ("left", "of revoked", "of another"):
        assert not opened(as_cookie(tokens[f"cookie {name}"]))
    assert not opened({})
