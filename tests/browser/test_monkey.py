"""Random clicks, and forms with random values, on every page of a filled service: no error of the service, none in the
browser's console, no refusal without a remedy. A seed and a page repeat what was done, step for step.
"""

from __future__ import annotations

import io
import json
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, ElementHandle, Error, JSHandle, Page, Response

from tests.app.conftest import zipped
from tests.app.test_drafts import record
from tests.browser.test_live import streaming
from tests.browser.test_pages import SHORT
from tests.browser.window import LOADED, SETTLED, Window, hearing, signed_in, visit
from tests.running import Service, process

SEED = 50
MANY = 100  # actions on a page
FIELDS = 4  # of a form that is filled in before it is sent
PATIENCE = 1500.0  # ms for an element that something else may cover, or that is gone
CONTROLS = "a[href], button, summary, input, select, textarea, [role=tab], [tabindex='0'], th button"
SPARED = "form.out button"  # signing out: of a stranger there is nothing to be seen but the page that signs in
REFUSED = "the server responded with a status of 4"  # what the browser notes of each refusal
LONG = "x" * 5000
TEXTS = (
    "", " ", "0", "1", "-1", "1e308", "-1e-308", "nan", "inf", "3.6 ms", "3,6 ms", "497 mm^2", "5 mm:1 mm", "1000 Hz",
    "0 Hz", "tau", "dead_zone", "SW-1", "none", "🛠 é ß 测试 \u202eabc", "\u0000\t", "<b>x</b><script>alert(1)</script>",
    "'; DROP TABLE fits; --", "{{ 7 * 7 }}", "../../etc/passwd", "a,b\n1,2", '{"a": [1, 2}', "equation: q = q - h",
    "9" * 400, LONG, "-", ":", "=", "%00%ff", "2026-02-30", "w = w - h", "https://127.0.0.1:9/hook",
)  # fmt: skip
"""What is typed: right, wrong, empty, odd, too long, markup, and what other programs take for a command."""


@dataclass
class Seen:
    """What went wrong, and the answers that have still to be looked at."""

    steps: list[str] = field(default_factory=list)
    wrong: list[str] = field(default_factory=list)
    answers: list[Response] = field(default_factory=list)

    def listening(self, page: Page) -> AbstractContextManager[None]:
        """Hear everything that a page says."""
        return hearing(
            page,
            {
                "console": lambda message: self.said(message.type, message.text),
                "pageerror": lambda error: self.fault(f"error in the page: {error}"),
                "response": lambda answer: self.answers.append(answer),  # noqa: PLW0108 - a bound method cannot be marked
                "dialog": lambda dialog: dialog.dismiss(),
            },
        )

    def said(self, kind: str, text: str) -> None:
        """A line of the console; that an answer was a refusal is judged by the answer."""
        if kind in ("error", "warning") and REFUSED not in text:
            self.fault(f"console: {text}")

    def fault(self, what: str) -> None:
        """Note a fault with the way to it."""
        self.wrong.append(f"{what}\n    after {'; '.join(self.steps[-6:])}")

    def look(self) -> None:
        """Judge the answers that have come."""
        for answer in [self.answers.pop(0) for _ in range(len(self.answers))]:
            if answer.status >= 500 and answer.status != 507:
                self.fault(f"{answer.request.method} {answer.url}: {answer.status}")
            elif answer.status >= 400 and "problem+json" in answer.headers.get("content-type", ""):
                self._problem(answer)

    def _problem(self, answer: Response) -> None:
        try:
            said = json.loads(answer.text())
        except (Error, ValueError):  # of a page that was left, nothing can be asked
            return
        if not (said.get("detail") or said.get("what")) or not said.get("remedy"):
            self.fault(f"{answer.request.method} {answer.url}: {answer.status} without a remedy: {answer.text()[:300]}")


@pytest.fixture(scope="module")
def zoo(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    """A service of its own, for everything in it may be changed."""
    with process(tmp_path_factory.mktemp("zoo")) as service:
        yield service


@pytest.fixture(scope="module")
def cage(
    launch_browser: Callable[..., Browser], browser_type_launch_args: dict[str, object], zoo: Service
) -> Iterator[Window]:
    """A window that is signed in there."""
    yield from signed_in(launch_browser, browser_type_launch_args, zoo)


@pytest.fixture
def watch() -> None:
    """The listener of the other tests takes a refusal for a complaint."""


@pytest.fixture(scope="module")
def filled(zoo: Service) -> dict[str, str]:
    """Something of every kind; the address of each page."""
    client = zoo.client
    matrix = client.post("/matrices", files={"files": ("m.zip", zipped("SW-1"))}).json()["id"]
    files = [("files", (f"{name}.csv", record(seed))) for seed, name in enumerate("ab")]
    draft = client.post("/drafts", files=files).json()["id"]
    first, second = zoo.fit(matrix, options=SHORT), zoo.fit(matrix, seed=1, options=SHORT)
    for fit in (first, second):
        assert zoo.ended(fit)["state"] == "succeeded"
    client.post(f"/fits/{first}/approve", json={"why": "as measured"})
    client.post("/tokens", json={"name": "line 3", "role": "line"})
    client.put("/limits/qian2014", json={"limits": {"tau": {"lower": 1e-3, "upper": 9e-3}}})
    regression = client.post("/regressions", json={}).json().get("id", "none")
    return {
        "actuators": "/", "actuator": "/actuators/SW-1", "upload": "/upload", "draft": f"/drafts/{draft}",
        "draft-apart": f"/drafts/{draft}?apart=true", "matrix": f"/matrices/{matrix}", "jobs": "/jobs",
        "job": f"/jobs/{second}", "workers": "/workers", "fit": f"/fits/{first}", "second-fit": f"/fits/{second}",
        "use": f"/fits/{first}/use", "effects": "/effects", "compare": f"/compare?fits={first},{second}",
        "statistics": "/statistics?parameter=tau", "limits": "/limits", "regressions": "/regressions",
        "regression": f"/regressions/{regression}", "tokens": "/tokens", "audit": "/audit", "webhooks": "/webhooks",
        "retention": "/retention", "not-found": "/fits/none", "sign-in": "/sign-in",
         "live": "/live", "plan": f"/plan?fit={first}", "search": "/search?q=SW", "units": "/units",
    }  # fmt: skip


PAGES = (
    "actuators", "actuator", "upload", "draft", "draft-apart", "matrix", "jobs", "job", "workers", "fit", "second-fit",
    "use", "effects", "compare", "statistics", "limits", "regressions", "regression", "tokens", "audit", "webhooks",
    "retention", "not-found", "sign-in", "live", "plan", "search", "units",
)  # fmt: skip


def test_every_page_of_the_service_is_visited():
    """All routes of pages but pictures, files and what a form posts; a new page has to be named above."""
    from app.main import routed

    routes = [route for route in routed().routes if not getattr(route, "include_in_schema", True)]
    asked = {
        route.path.strip("/").partition("/")[0]
        for route in routes
        if "GET" in getattr(route, "methods", ()) and "{path" not in route.path and "." not in route.path
    }
    named = {"fits", "drafts", "matrices", "actuators", "jobs", *PAGES, ""}
    assert asked <= named | {"static", "fonts", "sign-out"}, asked - named


@pytest.mark.full
@pytest.mark.parametrize("name", PAGES)
def test_random_clicks_and_forms_are_answered(name, cage, zoo, filled, tmp_path):
    seen, random = Seen(), np.random.default_rng([SEED, PAGES.index(name)])
    page, address = cage.page, zoo.address + filled[name]
    page.set_default_timeout(LOADED)
    with seen.listening(page), streaming(zoo, "rig") if name == "live" else nullcontext():
        visit(page, address)
        for _ in range(MANY):
            try:
                act(page, random, seen, tmp_path)
                page.wait_for_timeout(SETTLED)
            except Error as error:  # covered, moved or gone: nobody could have pressed it
                seen.steps.append(f"({str(error).splitlines()[0][:80]})")
            seen.look()
            for other in page.context.pages[1:]:
                cage.close(other)
            if not page.url.startswith(zoo.address) or random.random() < 0.1 or elsewhere(page, address):
                visit(page, address)
                if page.get_by_role("heading", name="Sign in").count() and name != "sign-in":
                    visit(page, f"{zoo.address}/?token={zoo.token}")
                    visit(page, address)
        seen.look()
    cage.clear()
    for job in zoo.client.get("/jobs").json()["items"]:
        if job["state"] in ("queued", "running"):
            zoo.client.delete(f"/jobs/{job['id']}")
    assert not seen.wrong, "\n".join([f"{name} ({address})", *dict.fromkeys(seen.wrong)])


@pytest.mark.full
def test_what_goes_wrong_on_a_page_is_noted_with_the_way_to_it(cage, zoo):
    """An error in a script, one in the console, an answer of 500, a refusal without a remedy; no other refusal."""
    seen, page = Seen(["click here"]), cage.page
    with seen.listening(page):
        visit(page, f"{zoo.address}/upload")
        page.route("**/broken", lambda route: route.fulfill(status=500))
        problem = {"content_type": "application/problem+json", "status": 422}
        page.route("**/mute", lambda route: route.fulfill(body='{"what": "no", "remedy": ""}', **problem))
        page.route("**/told", lambda route: route.fulfill(body='{"what": "no", "remedy": "say yes"}', **problem))
        page.evaluate("setTimeout(() => { throw new Error('thrown') })")
        page.evaluate("console.error('said')")
        for path in ("broken", "mute", "told"):
            page.evaluate(f"fetch('/{path}').then((answer) => answer.text())")
        seen.look()
    cage.clear()
    for told in ("thrown", "console: said", "/broken: 500", "/mute: 422 without a remedy"):
        assert any(told in fault and "after click here" in fault for fault in seen.wrong), told
    assert not any("/told" in fault for fault in seen.wrong)


def elsewhere(page: Page, address: str) -> bool:
    """Whether an action led to another page; a problem page among them says what to do."""
    return page.url.partition("#")[0].partition("?")[0] != address.partition("?")[0]


def act(page: Page, random: np.random.Generator, seen: Seen, folder: Path) -> None:
    """One action on what is to be seen: a click, a choice, or a value in a field; of a form at times all of them."""
    chosen = one_of(page.evaluate_handle("document.documentElement"), CONTROLS, random)
    if chosen is None:
        page.reload()
        return
    form = chosen.evaluate_handle("field => field.form ?? null").as_element() if random.random() < 0.5 else None
    if form is None:
        operate(chosen, random, seen, folder)
        return
    for _ in range(FIELDS):
        if field := one_of(form, "input, select, textarea", random):
            operate(field, random, seen, folder)
    if sent := one_of(form, "button", random):
        operate(sent, random, seen, folder)


def one_of(place: JSHandle, controls: str, random: np.random.Generator) -> ElementHandle | None:
    """One of the controls of a place that a person could press, or type into, and is not signed out by."""
    found = place.evaluate_handle(
        """(place, [controls, spared]) => [...place.querySelectorAll(controls)].filter((control) =>
             !control.disabled && !control.matches(spared) && control.getClientRects().length > 0
             && control.checkVisibility({ visibilityProperty: true }))""",
        [controls, SPARED],
    )
    count = int(found.evaluate("list => list.length"))
    number = int(random.integers(count)) if count else 0
    return found.evaluate_handle("(list, number) => list[number]", number).as_element() if count else None


def operate(control: ElementHandle, random: np.random.Generator, seen: Seen, folder: Path) -> None:
    """What a control is for, with a random value where it takes one."""
    what: dict[str, Any] = control.evaluate(
        """control => ({ tag: control.localName, type: control.type ?? "", name: control.name || control.id || "",
             text: (control.ariaLabel ?? control.textContent ?? "").trim().slice(0, 40), href: control.href ?? "" })"""
    )
    named = f"{what['tag']} {what['name'] or what['text'] or what['href']!r}"
    if what["tag"] == "select":
        values = control.evaluate("control => [...control.options].map((option) => option.index)")
        index = int(random.choice(values)) if values else 0
        seen.steps.append(f"choose {index} in {named}")
        control.select_option(index=index, timeout=PATIENCE)
    elif what["type"] == "file":
        path = some_file(random, folder)
        seen.steps.append(f"give {path.name} to {named}")
        if not control.evaluate("control => control.webkitdirectory"):
            control.set_input_files(path, timeout=PATIENCE)
    elif what["tag"] == "textarea" or (
        what["tag"] == "input" and what["type"] not in ("checkbox", "radio", "range", "color", "submit", "button")
    ):
        text = str(random.choice(TEXTS))
        if what["type"] == "number":
            text = str(random.choice(["", "0", "-1", "1", "7", "1e9", "0.5"]))
        if what["type"] in ("date", "datetime-local", "time", "month"):
            text = ""
        seen.steps.append(f"type {text[:30]!r} into {named}")
        control.fill(text, timeout=PATIENCE)
        if random.random() < 0.3:
            control.press("Enter", timeout=PATIENCE, no_wait_after=True)
    else:
        seen.steps.append(f"click {named}")
        control.click(timeout=PATIENCE, no_wait_after=True)


def some_file(random: np.random.Generator, folder: Path) -> Path:
    """A file that a person may give by mistake, or a right one."""
    kinds = {
        "right.csv": record(int(random.integers(100)), "t [s],command [mm],position [mm]"),
        "words.csv": "Größe;Wert\nviel;wenig\n".encode(),
        "empty.csv": b"",
        "matrix.zip": zipped("SW-1")[: int(random.integers(2, 4000))],
        "not.zip": b"PK\x03\x04" + bytes(range(256)),
        "matrix.yaml": b"actuator: {serial: [1, 2}\nruns: &a [*a]\n",
        "définition – ü.yaml": b"place: spool\nequation: w = w - h*tanh(w/h)\n",
        "numbers.txt": b"\n".join(b"%g" % value for value in random.normal(size=50)),
        "odd.json": b'{"a": NaN, "b": ["\\ud800"]}',
        "table.npz": packed(random),
    }
    name = str(random.choice(list(kinds)))
    (folder / name).write_bytes(kinds[name])
    return folder / name


def packed(random: np.random.Generator) -> bytes:
    buffer = io.BytesIO()
    np.savez(buffer, command=random.normal(size=100), displacement=random.normal(size=99))
    return buffer.getvalue()
