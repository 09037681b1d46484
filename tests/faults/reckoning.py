"""What came of a load under faults, against what was acknowledged and against an undisturbed run."""

from __future__ import annotations

import time
from dataclasses import asdict, dataclass
from typing import Any

from tests.app.conftest import zipped
from tests.faults.load import SEARCH, SEEDS, SERIALS, Asked, Client, Load, timeless
from tests.faults.strikes import Struck
from tests.faults.world import World
from tests.running import ENDED

Results = dict[tuple[str, tuple[str, int]], Any]
PATIENCE = 600.0  # s for all that is queued to end


@dataclass
class Reckoning:
    """The counts: what is to be 0, or nothing, where the service holds is in `holds`."""

    submitted: int
    ended: int
    cancelled: int
    twins: int
    lost: int
    uploads_lost: int
    failed: list[str]
    stored_twice: int
    differing: int
    in_force_twice: int
    approved_and_not_in_force: int
    orphaned: int
    uploads: int
    approvals: int
    wrongly_answered: list[str]
    refused_for_a_moment: int
    kills: dict[str, int]
    others: dict[str, int]
    moved: list[float]

    @property
    def holds(self) -> bool:
        """Whether nothing was lost, stored twice or changed."""
        bad = (
            self.lost,
            self.uploads_lost,
            self.failed,
            self.stored_twice,
            self.differing,
            self.in_force_twice,
            self.approved_and_not_in_force,
            self.orphaned,
            self.wrongly_answered,
        )
        return not any(bad) and max(self.moved, default=0.0) <= 15.0

    def to_json(self) -> dict[str, Any]:
        return asdict(self)


def undisturbed(world: World, diagnoses: bool) -> tuple[dict[str, str], dict[tuple[str, int], str], Results]:
    """Matrices, a fit of each with each seed, and a diagnosis, made before anything strikes."""
    client = Client(world.address)
    matrices, fits, results = {}, {}, {}
    for serial in SERIALS:
        stored = client.asked("POST", "/matrices", files={"files": ("a.zip", zipped(serial))})
        matrices[serial] = stored.json()["id"]
        for seed in SEEDS:
            asked = {"matrix": matrices[serial], "seed": seed, "options": SEARCH}
            fits[serial, seed] = made(client, "/fits", asked)
            results["fit", (serial, seed)] = result(client, "fit", fits[serial, seed])
    of = (SERIALS[0], SEEDS[0])
    if diagnoses:
        diagnosis = made(client, "/diagnoses", {"fit": fits[of], "max_effects": 1, "seed": 1})
        results["diagnosis", of] = result(client, "diagnosis", diagnosis)
    return matrices, fits, results


def made(client: Client, path: str, body: dict[str, Any]) -> str:
    """The id of a job that has succeeded."""
    answer = client.asked("POST", path, json=body)
    job = str(answer.json()["id"])
    assert state(client, job) == "succeeded"
    return job


def state(client: Client, job: str) -> str:
    """How a job ended; "missing" where there is none, "open" where it does not end."""
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        answer = client.asked("GET", f"/jobs/{job}")
        if answer.status_code == 404:
            return "missing"
        if answer.json()["state"] in ENDED:
            return str(answer.json()["state"])
        time.sleep(0.2)
    return "open"


def result(client: Client, kind: str, job: str) -> Any:
    """What a job made, without its times; None where there is nothing."""
    path = f"/fits/{job}" if kind == "fit" else f"/diagnoses/{job}"
    answer = client.asked("GET", path)
    if answer.status_code == 404:
        return None
    return timeless(answer.json()["result"] if kind == "fit" else answer.json())


def reckon(world: World, loads: list[Load], before: Results, struck: Struck) -> Reckoning:
    """Wait for all that was acknowledged, and compare."""
    client = Client(world.address)
    asked = [one for load in loads for one in load.account.asked]
    states = {one.job: state(client, one.job) for one in asked}
    succeeded = [one for one in asked if states[one.job] == "succeeded"]
    differing = sum(result(client, one.kind, one.job) != before[one.kind, one.of] for one in succeeded)
    sets = everything(client, "/parameter-sets")
    extra = len(sets) + len(everything(client, "/diagnoses")) - len(succeeded) - len(before)
    uploads = set().union(*(load.account.uploads for load in loads))
    in_force = [each["serial"] for each in sets if each["current"]]
    approved = {each["serial"] for each in sets if each["approved_at"]}
    world.command("tidy", "--older-than", "0", "--yes")
    left = world.command("tidy", "--older-than", "0")
    return Reckoning(
        submitted=len(asked),
        ended=sum(each in ENDED for each in states.values()),
        cancelled=sum(each == "cancelled" for each in states.values()),
        twins=sum(load.account.twins for load in loads),
        lost=sum(each in ("missing", "open") for each in states.values()) + unasked(asked, states),
        uploads_lost=sum(not readable(client, matrix) for matrix in uploads),
        failed=[problem(client, job) for job, each in states.items() if each == "failed"],
        stored_twice=max(extra, 0),
        differing=differing,
        in_force_twice=len(in_force) - len(set(in_force)),
        approved_and_not_in_force=len(approved - set(in_force)),
        orphaned=0 if left.startswith("0 ") else len(left.splitlines()) - 1,
        uploads=len(uploads),
        approvals=sum(load.account.approvals for load in loads),
        wrongly_answered=[each for load in loads for each in load.account.wrong],
        refused_for_a_moment=sum(load.client.refused for load in loads),
        kills=struck.kills,
        others=struck.others,
        moved=[round(seconds, 1) for seconds in struck.moved],
    )


def unasked(asked: list[Asked], states: dict[str, str]) -> int:
    """Jobs that were cancelled and nobody had asked for it."""
    return sum(states[one.job] == "cancelled" and not one.cancelled for one in asked)


def readable(client: Client, matrix: str) -> bool:
    """Whether an upload that was acknowledged is recorded, and its raw bytes are there."""
    return client.asked("GET", f"/matrices/{matrix}/description").status_code == 200


def problem(client: Client, job: str) -> str:
    """Why a job failed."""
    found = client.asked("GET", f"/jobs/{job}").json()["problem"]
    return f"{found['code']}: {found['detail']}"


def everything(client: Client, path: str) -> list[dict[str, Any]]:
    """Every entry of a list."""
    found: list[dict[str, Any]] = []
    cursor: str | None = None
    while True:
        answer = client.asked("GET", path, params={"limit": 200} | ({"cursor": cursor} if cursor else {}))
        page = answer.json()
        found += page["items"]
        cursor = page.get("next")
        if cursor is None:
            return found
