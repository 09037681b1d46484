"""A page offers nothing that would be refused: each link, form and button of each page, for each role, by the table."""

from __future__ import annotations

import re
from collections.abc import Iterator
from html.parser import HTMLParser
from urllib.parse import urlsplit

import pytest
from fastapi.testclient import TestClient

from app.pages.rendering import HERE
from tests.app.access.table import API, EVERY, OF_API, PAGES, Call
from tests.app.access.test_audit import RAW
from tests.short_form import short_form

ROUTES = [*((API + call.path, call) for call in OF_API), *((call.path, call) for call in PAGES[:-1])]
ASKS = {
    "data-cancel": "DELETE /jobs/{job}",
    "data-conclude": "POST /jobs/{job}/conclude",
    "data-own": "POST /diagnoses",
    "data-run": "POST /matrices/{matrix}/revisions",
    "data-new-token": "POST /tokens",
    "data-limits": "PUT /limits/{model}",
    "data-regression": "POST /regressions",
    "data-digest": "POST /retention",
    "data-new-webhook": "POST /webhooks",
    "data-approve": "POST /fits/{fit}/approve",
    "data-revoke": "DELETE /tokens/{token}",
    "data-drop": "DELETE /own-effects/{name}",
    "data-add": "POST /fits/{fit}/effects",
    "data-diagnose": "POST /diagnoses",
    "data-keep": "POST /own-effects",
    "data-mend": "POST /matrices/{matrix}/revisions",
    "data-live-mark": "POST /live/{name}/marks",
    "data-live-record": "PUT /live/{name}/recording",
    "data-live-keep": "POST /live/{name}/recording",
    "data-propose": "GET /diagnoses/{diagnosis}/proposal",
}
"""What a form or a button with this attribute asks for, where its address does not say it."""
WITHIN = {"data-pick", "data-close", "data-more", "data-less", "role", "data-format", "data-clear"}
"""Attributes of buttons that change only what is seen."""
FIELDS = {"input", "select", "textarea"}
CALLS = {call.name: call for call in (*PAGES, *OF_API)}


class Offers(HTMLParser):
    """The calls that a page offers: method and address."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.found: list[tuple[str, str]] = []
        self.asked: list[str] = []
        self.unknown: list[str] = []
        self.form: dict[str, str | None] | None = None
        self.feed(text)

    def handle_starttag(self, tag: str, given: list[tuple[str, str | None]]) -> None:
        here = dict(given)
        if tag == "a" and (here.get("href") or "").startswith("/"):
            self.found.append(("GET", str(here["href"])))
        if tag == "form":
            self.form = here
            self._acts(here, str(here.get("method") or "get").upper(), str(here.get("action") or ""))
        elsewhere = "form" in here  # such a button sends a form that is looked at by itself
        if tag == "button" and not (self._asks(here) or self.form or elsewhere or WITHIN & here.keys()):
            self.unknown.append(str(here))

    def handle_endtag(self, tag: str) -> None:
        if tag == "form":
            self.form = None

    def _acts(self, here: dict[str, str | None], method: str, action: str) -> None:
        if action.startswith("/"):
            self.found.append((method, action))
        elif not self._asks(here) and here.get("id") not in ("pick", "mend") and method not in ("GET", "DIALOG"):
            self.unknown.append(str(here))

    def _asks(self, here: dict[str, str | None]) -> bool:
        asked = [ASKS[name] for name in here if name in ASKS]
        self.asked += asked
        return bool(asked)


class Markup(HTMLParser):
    """The fields of a page that no label names, and the rows of its tables by their width in columns."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.fields: list[dict[str, str | None]] = []
        self.named: set[str | None] = set()
        self.widths: list[list[int]] = []
        self.open: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, given: list[tuple[str, str | None]]) -> None:
        here = dict(given)
        if tag in {"label", "template"}:  # of a template scripts make fields, each with its label
            self.open.append(tag)
            self.named.add(here.get("for"))
        elif (
            tag in FIELDS and here.get("type") != "hidden" and not ({"hidden", "aria-label"} & here.keys() or self.open)
        ):
            self.fields.append(here)
        elif tag == "table":
            self.widths.append([])
        elif tag == "tr" and self.widths:
            self.widths[-1].append(0)
        elif tag in {"td", "th"} and self.widths and self.widths[-1]:
            self.widths[-1][-1] += int(here.get("colspan") or 1)

    def handle_endtag(self, tag: str) -> None:
        if tag in {"label", "template"} and self.open:
            self.open.pop()

    @property
    def unlabelled(self) -> list[dict[str, str | None]]:
        """Fields without a label, a name of their own or a label around them."""
        return [one for one in self.fields if one.get("id") not in self.named - {None}]

    @property
    def ragged(self) -> list[list[int]]:
        """The widths of the rows of each table whose rows differ."""
        return [widths for widths in self.widths if len(set(widths)) > 1]


def call_of(method: str, address: str) -> Call | None:
    """The route that an address is of."""
    path = urlsplit(address).path
    for route, call in ROUTES:
        whole = re.escape(route).replace("\\{serial\\}", ".+").replace("/manual/\\{name\\}", "/manual/.+")
        pattern = re.sub(r"\\{\w+\\}", lambda _: "[^/]+", whole)
        if call.method == method and (re.fullmatch(pattern, path) or re.fullmatch(pattern, f"{path}.kind")):
            return call
    return None


@pytest.fixture(scope="module")
def pages(service: TestClient, matrix: str, fitted: str) -> Iterator[dict[str, str]]:
    """The address of each page with something on it, also of a job that runs, by the name of its route."""
    running = service.post(f"{API}/fits", json={"matrix": matrix, "seed": 5, "options": {"generations": 10_000}}).json()
    effect = {
        "name": "offered",
        "place": "flow",
        "equation": "Q = Q - kq*Q",
        "strength": {"symbol": "kq", "unit": "1", "lower": 0, "upper": 1},
    }
    service.post(f"{API}/own-effects", json={"name": "offered", "definition": effect})
    service.post(f"{API}/tokens", json={"name": "somebody", "role": "line"})
    service.post(f"{API}/webhooks", json={"url": "http://127.0.0.1:9/offered", "events": ["limit.broken"]})
    regression = service.post(f"{API}/regressions", json={"serial": "nobody"}).json()["id"]
    draft = service.post(f"{API}/drafts", files={"files": ("run.csv", RAW)}).json()["id"]
    about = {
        "serial": "SW-1",
        "matrix": matrix,
        "fit": fitted,
        "regression": regression,
        "draft": draft,
        "name": "index",
    }
    shown = [call for call in PAGES if call.method == "GET" and not re.search(r"\.svg|\.json|job|\{path", call.path)]
    found = {call.path: f"{call.path.format(**about)}?{call.query.format(**about)}" for call in shown}
    yield found | {"a running job": f"/fits/{running['id']}"}
    service.delete(f"{API}/jobs/{running['id']}")
    service.delete(f"{API}/own-effects/offered")


@pytest.mark.parametrize("role", short_form(EVERY, "lab"))
def test_no_page_offers_what_is_refused(service: TestClient, pages: dict[str, str], role: str) -> None:
    """A page that a role may not see is refused; on the others everything that can be clicked is allowed."""
    token = service.post(f"{API}/tokens", json={"name": f"sees {role}", "role": role}).json()["token"]
    offered = set()
    for name, address in pages.items():
        answer = service.get(address, headers={"Authorization": f"Bearer {token}"})
        call = CALLS.get(f"GET {name}")
        if call is not None and not call.free and role not in call.roles:
            assert answer.status_code == 403, name
            continue
        assert answer.status_code == 200, (name, answer.text[-500:])
        offers = Offers(answer.text)
        assert offers.unknown == [], name
        asked = [(text, CALLS[text]) for text in offers.asked]
        for method, to in offers.found:
            found = call_of(method, to)
            assert found is not None, (name, method, to)
            asked.append((to, found))
        refused = [text for text, one in asked if not one.free and role not in one.roles]
        assert refused == [], name
        offered |= {one.name for _, one in asked}
    lab = {"POST /fits", "DELETE /jobs/{job}", "POST /fits/{fit}/effects", "PUT /limits/{model}", "POST /diagnoses"}
    assert (lab <= offered) is (role in ("lab", "admin"))
    assert ("POST /regressions" in offered) is (role != "line")
    assert ({"POST /backups", "POST /tokens", "POST /webhooks"} <= offered) is (role == "admin")


def test_what_a_search_found_is_offered_to_those_who_may_use_it() -> None:
    """The forms on its cards, in the templates themselves: a diagnosis for each would take minutes."""
    form = re.compile(r'(\{% if who\.has\("lab"\) %\})?<form\b[^>]*\bdata-(?:add|diagnose|mend|keep|drop|make)=')
    found = [
        match[1] for file in (HERE / "templates").glob("*.html") for match in form.finditer(file.read_text("utf-8"))
    ]
    assert len(found) > 10
    assert all(found)


def test_every_field_has_a_label_and_every_column_of_a_table_a_heading(service: TestClient, pages: dict[str, str]):
    """As the service sends the page; what scripts add is looked at in the browser."""
    for path, address in pages.items():
        text = service.get(address).text
        found = Markup(text)
        assert len(re.findall("<h1[ >]", text)) == 1, path
        assert found.unlabelled == [], path
        assert found.ragged == [], path


def test_a_field_without_a_label_and_a_short_row_are_found():
    sound = "<label for=a>A</label><input id=a><label>B<select></select></label><table><tr><th>1<tr><td>2</table>"
    assert (Markup(sound).unlabelled, Markup(sound).ragged) == ([], [])
    assert Markup(sound.replace("for=a", "")).unlabelled == [{"id": "a"}]
    assert Markup(sound.replace("<tr><td>2", "<tr><td>2<td>3")).ragged == [[1, 2]]
