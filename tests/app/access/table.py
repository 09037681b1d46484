"""Who may call what, written down by hand: every route of the API, every page, the WebSocket."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

EVERY = ("lab", "line", "ci", "admin")
LAB = ("lab", "admin")
RECHECKERS = ("lab", "ci", "admin")
ADMIN = ("admin",)
API = "/api/v1"


@dataclass(frozen=True)
class Call:
    """A call, who may make it, and what it sends. `changes` says that the audit has it.

    In path and body, {matrix}, {fit} and so on stand for what the test has made: see `made` in test_roles.py.
    """

    method: str
    path: str
    roles: tuple[str, ...]
    body: Any = None
    query: str = ""
    form: dict[str, str] = field(default_factory=dict)
    changes: bool = False
    free: bool = False

    @property
    def name(self) -> str:
        """As a test is called."""
        return f"{self.method} {self.path}"


def read(path: str, query: str = "") -> Call:
    """A look, by every role."""
    return Call("GET", path, EVERY, query=query)


FIGURE = "figures/{name}.{kind}"
CASE = {"fit": "{fit}", "case": "qian"}
CUSTOM = {
    "name": "leak",
    "place": "flow",
    "equation": "Q = Q - kq*Q",
    "strength": {"symbol": "kq", "unit": "1", "lower": 0, "upper": 1},
}

OF_API = (
    Call("GET", "/health", (), free=True),
    Call("GET", "/ready", (), free=True),
    read("/metrics"),
    read("/openapi.json"),
    Call("GET", "/tokens", ADMIN),
    Call("POST", "/tokens", ADMIN, {"name": "station", "role": "line", "expires": "1d"}, changes=True),
    Call("DELETE", "/tokens/{token}", ADMIN, changes=True),
    Call("GET", "/audit", ADMIN),
    read("/display-units"),
    Call("PUT", "/display-units", EVERY, {"units": ["bar"]}, changes=True),
    Call("GET", "/workers", ADMIN),
    Call("POST", "/matrices", LAB, "the archive", changes=True),
    read("/matrices"),
    read("/matrices/{matrix}"),
    read("/matrices/{matrix}/description"),
    Call("POST", "/matrices/{matrix}/revisions", LAB, {"actuator": {"notes": "mended"}}, changes=True),
    read("/matrices/{matrix}/" + FIGURE),
    read("/matrices/{matrix}/track"),
    read("/matrices/{matrix}/track/" + FIGURE),
    Call("POST", "/drafts", LAB, "raw files", changes=True),
    Call("GET", "/drafts/{draft}", LAB),
    Call("POST", "/drafts/{draft}", LAB, {"serial": "SW-1"}),
    Call("POST", "/drafts/{draft}/matrix", LAB, {"serial": "SW-1"}, changes=True),
    read("/actuators"),
    read("/actuators/{serial}"),
    read("/actuators/{serial}/verdict"),
    read("/limits"),
    read("/limits/{model}"),
    Call("PUT", "/limits/{model}", LAB, {"limits": {"tau": {"upper": 5, "unit": "ms"}}}, changes=True),
    read("/statistics", "parameter=tau"),
    read("/statistics/figures/control-chart.{kind}", "parameter=tau"),
    read("/statistics/over", "parameter=tau"),
    read("/statistics/figures/dependence.{kind}", "parameter=tau"),
    Call("POST", "/webhooks", ADMIN, {"url": "http://127.0.0.1:9/hook", "events": ["limit.broken"]}, changes=True),
    Call("GET", "/retention", ADMIN),
    Call("POST", "/retention", ADMIN, {"digest": "{digest}"}, changes=True),
    Call("POST", "/backups", ADMIN, changes=True),
    Call("GET", "/webhooks", ADMIN),
    Call("DELETE", "/webhooks/{webhook}", ADMIN, changes=True),
    Call("GET", "/webhooks/{webhook}/deliveries", ADMIN),
    Call("POST", "/regressions", RECHECKERS, {"serial": "nobody"}, changes=True),
    read("/regressions"),
    read("/regressions/{regression}"),
    Call("POST", "/fits", LAB, {"matrix": "{matrix}", "seed": 7}, changes=True),
    read("/fits/{fit}"),
    read("/fits/{fit}/export.{kind}"),
    read("/fits/{fit}/compare"),
    read("/fits/{fit}/budget"),
    read("/fits/{fit}/error-sizes"),
    Call("POST", "/fits/{fit}/profiles", LAB, {"parameter": "tau"}, changes=True),
    read("/fits/{fit}/profile", "parameter=tau"),
    read("/fits/{fit}/beside", "other={fit}"),
    read("/fits/{fit}/ladder"),
    read("/fits/{fit}/" + FIGURE),
    read("/fits/{fit}/export.{kind}"),
    read("/fits/{fit}/report.html"),
    read("/fits/{fit}/report.pdf"),
    read("/fits/{fit}/tables.xlsx"),
    read("/fits/{fit}/tables.zip"),
    read("/fits/{fit}/tables/{name}.csv"),
    Call("POST", "/fits/{fit}/approve", LAB, changes=True),
    read("/fits/{fit}/annotation"),
    Call("PUT", "/fits/{fit}/annotation", LAB, {"name": "cold oil"}, changes=True),
    read("/fits/{fit}/deletion"),
    read("/search"),
    Call("DELETE", "/fits/{fit}", LAB, changes=True),
    Call("POST", "/fits/{fit}/withdraw", LAB, changes=True),
    Call("POST", "/fits/{fit}/effects", LAB, {"effect": "dead_zone"}, changes=True),
    Call("POST", "/fits/{fit}/what-if", EVERY, {"gain": [2, 3]}),
    read("/fits/{fit}/what-if/" + FIGURE),
    Call("POST", "/fits/{fit}/position-loop", EVERY, {"kp": 100}),
    read("/fits/{fit}/position-loop/" + FIGURE),
    read("/fits/{fit}/sheet"),
    read("/fits/{fit}/identification.h"),
    Call("POST", "/diagnoses", LAB, {"fit": "{fit}", "max_effects": 1}, changes=True),
    read("/diagnoses"),
    read("/diagnoses/{diagnosis}"),
    read("/diagnoses/{diagnosis}/proposal"),
    read("/diagnoses/{diagnosis}/next-experiment"),
    read("/jobs"),
    read("/jobs/{job}"),
    read("/jobs/{job}/events"),
    Call("DELETE", "/jobs/{job}", LAB, changes=True),
    Call("POST", "/jobs/{job}/conclude", LAB, changes=True),
    read("/parameter-sets"),
    read("/models"),
    read("/effects"),
    Call("POST", "/custom-effects", EVERY, CUSTOM),
    read("/own-effects"),
    Call("POST", "/own-effects", LAB, {"name": "leak", "definition": CUSTOM}, changes=True),
    read("/own-effects/{name}"),
    Call("DELETE", "/own-effects/{name}", LAB, changes=True),
    Call("POST", "/controllers", LAB, CASE, changes=True),
    read("/controllers"),
    read("/controllers/{controller}"),
    read("/controllers/{controller}.{kind}"),
    read("/controllers/{controller}/" + FIGURE),
    Call("POST", "/hybrid-simulations", LAB, CASE | {"controller": "none"}, changes=True),
    read("/hybrid-simulations"),
    read("/hybrid-simulations/{simulation}"),
    read("/hybrid-simulations/{simulation}/command.csv"),
    read("/hybrid-simulations/{simulation}/" + FIGURE),
    Call("POST", "/plans", LAB, {"program": {"amplitudes": ["1 mm"], "seconds": "1 s"}}, changes=True),
    read("/plans"),
    read("/plans/{plan}"),
    read("/plans/{plan}.zip"),
    read("/live"),
    read("/live/{name}"),
    read("/live/{name}/events"),
    Call("POST", "/live/{name}/marks", LAB, {"text": "warm"}),
    Call("PUT", "/live/{name}/recording", LAB, {"on": True}),
    Call("POST", "/live/{name}/recording", LAB, {"serial": "SW-1", "run": "r1"}),
    read("/stream/ekf"),
)
"""Below /api/v1."""

PAGES = (
    read("/"),
    read("/actuators/{serial}"),
    read("/search"),
    read("/units"),
    Call("GET", "/upload", LAB),
    read("/plan"),
    Call("GET", "/drafts/{draft}", LAB),
    Call("GET", "/drafts/{draft}/{file}/{column}.svg", LAB),
    read("/matrices/{matrix}"),
    read("/matrices/{matrix}/signals"),
    read("/matrices/{matrix}/thumbnails/{place}.svg"),
    read("/live"),
    read("/jobs"),
    read("/jobs/{job}"),
    read("/fits/{fit}"),
    read("/fits/{fit}/use"),
    read("/fits/{fit}/use/what-if.json"),
    Call("POST", "/use/reading", EVERY, {"text": "a: 1", "where": "case"}),
    read("/effects"),
    read("/manual/{name}"),
    read("/compare", "fits={fit},{fit}"),
    read("/statistics", "parameter=tau"),
    read("/limits"),
    read("/regressions"),
    read("/regressions/{regression}"),
    Call("GET", "/tokens", ADMIN),
    Call("GET", "/audit", ADMIN),
    Call("GET", "/workers", ADMIN),
    Call("GET", "/webhooks", ADMIN),
    Call("GET", "/retention", ADMIN),
    Call("GET", "/sign-in", (), free=True),
    Call("POST", "/sign-in", (), form={"token": "none"}, free=True),
    Call("POST", "/sign-out", EVERY, form={"nothing": ""}),
    read("/{path}"),
)
STATIC = (Call("GET", "/static/{edition}/{name}", (), free=True), Call("GET", "/static/{vega}", (), free=True))
SOCKETS = ("/api/v1/stream/ekf",)
