"""`servoident regress` over a line's approved actuators: errors computed again, stored runs fitted from scratch."""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from app.regress.recheck import Recheck
from app.regress.repository import Asked
from app.regress.service import regress
from app.settings import Settings
from benchmarks.table import Table
from ident.progress import silent
from tests.app.conftest import archived, packed
from tests.hidden_dead_zone import HALF_WIDTH
from tests.reference import nonlinear_reference, qian_reference
from tests.running import process

ACTUATORS = int(os.environ.get("BENCHMARK_ACTUATORS", "100"))
RUNS, SECONDS = 63, 2.0
GOALS = {"linear": 1.0, "dead_zone": 6.0}  # s an actuator, by the clock on two cores
TOLERANCE = 1e-3


def upload(effect: str, number: int) -> bytes:
    """An actuator's matrix: the same machine, a noise of its own."""
    trials = [trial for trial in qian_reference.trials() if trial.use == "fit"][:RUNS]
    asked: dict[str, Any] = {"seconds": SECONDS, "noise": 0.005, "seed": number}
    if effect == "linear":
        records = qian_reference.measure_all(qian_reference.Plant(), trials, hold="linear", **asked)
    else:
        records = nonlinear_reference.measure_all(
            nonlinear_reference.named({"dead_zone.h": HALF_WIDTH}), trials, **asked
        )
    return archived(packed(records, f"R-{number}"))


def approved(data: Path, effect: str) -> None:
    """So many actuators, fitted and approved by a service."""
    with process(data) as service:
        for number in range(ACTUATORS):
            sent = service.client.post("/matrices", files={"files": ("a.zip", upload(effect, number))})
            asked: dict[str, object] = {} if effect == "linear" else {"effects": [effect]}
            job = service.fit(sent.json()["id"], **asked)
            assert service.ended(job)["state"] == "succeeded"
            assert service.client.post(f"/fits/{job}/approve").status_code == 200


def rechecked(data: Path) -> Iterator[tuple[Recheck, float]]:
    """Each recheck and how long it took, with the reading of its matrix (s)."""
    began = time.monotonic()
    for one in regress(Settings(data=data), Asked(), TOLERANCE, silent):
        yield one, time.monotonic() - began
        began = time.monotonic()


def measure() -> Table:
    """The first actuator loads and compiles what all others use; it counts with them."""
    rows, met = [], True
    for effect, goal in GOALS.items():
        with tempfile.TemporaryDirectory() as folder:
            data = Path(folder)
            approved(data, effect)
            busy = time.process_time()
            found = list(rechecked(data))
            busy = time.process_time() - busy
        assert len(found) == ACTUATORS
        moved = sum(not one.passed for one, _ in found)
        taken = [seconds for _, seconds in found]
        mean, most = float(np.mean(taken)), max(taken)
        met &= mean <= goal and not moved
        rows.append((effect, f"{mean:.2f}", f"{most:.2f}", f"{busy / ACTUATORS:.2f}", str(moved)))
    return Table(
        "Regression",
        f"{ACTUATORS} approved actuators of {RUNS} runs of {SECONDS:g} s, rechecked one after the other (s each).",
        ("model", "by the clock, mean", "longest", "of processor", "moved"),
        rows,
        ", ".join(f"{effect} in {goal:g} s" for effect, goal in GOALS.items()) + " each on the average, none moved",
        met,
    )
