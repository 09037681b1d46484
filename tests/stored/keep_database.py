"""Keep what this version stores, for the tests of later ones: `python -m tests.stored.keep_database FOLDER`.

A service is run on a small matrix: a fit and its diagnosis, then the same two once more, the fit killed in the middle
of its search, the diagnosis while it waits behind that. FOLDER has both databases as SQL, the blobs as text, and what
the service answered. For another version, put this file into its checkout and run it there; before there were
turns at a job, `Dispatch.advance` of app/dispatch.py, which is given the job, stands for `Run.advance`.
"""

from __future__ import annotations

import json
import os
import sqlite3
import subprocess
import sys
import tempfile
import threading
from pathlib import Path
from typing import Any

from fastapi.testclient import TestClient

from app.jobs.steps import Run
from app.main import create_app
from app.settings import Settings
from tests.reference import nonlinear_reference as reference
from tests.reference import qian_reference as linear

API, TOKEN, KILLED = "/api/v1", "a-token-for-tests", 9
DATABASES = ("servoident", "queue")
SPARSE = 4  # every so many samples of the reference are kept
SEARCH = {"population": 16, "generations": 18, "elite": 4}
BLOCKS = 2  # of the search, before it is killed
DESCRIPTION = """
actuator: {serial: SW-1, batch: B1, piston_area: 497 mm^2}
runs:
"""
RUN = """
  - id: %(id)s
    file: %(id)s.csv
    sample_rate: 1024 Hz
    specimen: {mass: %(mass)g kg, stiffness: %(stiffness)g N/m, damping: 0 N*s/m}
    gain: %(gain)g
    use: %(use)s
    channels: {command: {column: command, unit: mm}, displacement: {column: displacement, unit: mm}}
"""


def matrix() -> dict[str, str]:
    """Six runs of half a second of a machine with a dead zone, all of it text: name → content."""
    trials = linear.trials()
    chosen = [trials[0], trials[13], trials[26], trials[39], trials[52], trials[-2]]
    hidden = reference.named({"dead_zone.h": 8e-5})
    records = reference.measure_all(hidden, chosen, seconds=0.5, noise=0.005, seed=3)
    text, found = DESCRIPTION, {}
    for record in records:
        cell, name = record.trial.cell, record.trial.id
        text += RUN % {
            "id": name,
            "mass": cell.mass,
            "stiffness": cell.stiffness,
            "gain": cell.gain,
            "use": record.trial.use,
        }
        pairs = zip(record.command[::SPARSE], record.displacement[::SPARSE], strict=True)
        rows = [f"{1e3 * command:.5g},{1e3 * displacement:.6g}\n" for command, displacement in pairs]
        found[f"{name}.csv"] = "".join(["command,displacement\n", *rows])
    return {"matrix.yaml": text, **found}


def serve(data: Path) -> None:
    """Store all of it in the folder `data`, and end as `kill -9` does."""
    steps, waiting = {}, threading.Event()
    advance = Run.advance

    def dying(self: Run, state: dict[str, Any]) -> dict[str, Any]:
        job = self.lease.job
        steps[job] = steps.get(job, 0) + 1
        if len(steps) == 2 and steps[job] > BLOCKS:
            waiting.wait()
            os._exit(KILLED)
        return advance(self, state)

    Run.advance = dying
    headers = {"Authorization": f"Bearer {TOKEN}"}
    with TestClient(create_app(Settings(data=data, token=TOKEN)), "http://127.0.0.1:8000", headers=headers) as client:
        answers: dict[str, Any] = {}

        def posted(path: str, **body: Any) -> str:
            answer = client.post(f"{API}{path}", **body)
            assert answer.status_code < 300, answer.text
            return str(answer.json()["id"])

        def ended(job: str) -> str:
            assert '"state":"succeeded"' in client.get(f"{API}/jobs/{job}/events").text
            return job

        made = posted("/matrices", files=[("files", file) for file in matrix().items()])
        fit = {"json": {"matrix": made, "seed": 1, "options": SEARCH}}
        found = ended(posted("/fits", **fit))
        asked = {"json": {"fit": found, "max_effects": 1, "seed": 1}}
        diagnosis = ended(posted("/diagnoses", **asked))
        for path in (
            f"/matrices/{made}",
            f"/fits/{found}",
            f"/diagnoses/{diagnosis}",
            f"/fits/{found}/ladder",
            f"/jobs/{found}",
            "/actuators/SW-1",
        ):
            answers[path] = client.get(f"{API}{path}").json()
        again = posted("/fits", **fit), posted("/diagnoses", **asked)
        kept = {"fit": found, "diagnosis": diagnosis, "killed": again[0], "queued": again[1], "answers": answers}
        (data / "answers.json").write_text(json.dumps(kept, indent=1, ensure_ascii=False), encoding="utf-8")
        waiting.set()
        threading.Event().wait()


def keep(folder: Path) -> None:
    """Both databases, the blobs and the answers of a service that was killed."""
    with tempfile.TemporaryDirectory() as place:
        data = Path(place)
        done = subprocess.run([sys.executable, "-m", "tests.stored.keep_database", place, "serve"], check=False)
        assert done.returncode == KILLED
        folder.mkdir(exist_ok=True)
        for name in DATABASES:
            with sqlite3.connect(data / f"{name}.sqlite") as database:
                lines = "\n".join(database.iterdump())
                (folder / f"{name}.sql").write_text(lines + "\n", encoding="utf-8")
        blobs = {blob.name: blob.read_text(encoding="utf-8") for blob in sorted((data / "blobs").glob("*/*"))}
        (folder / "blobs.json").write_text(json.dumps(blobs, indent=1), encoding="utf-8")
        (folder / "answers.json").write_bytes((data / "answers.json").read_bytes())


if __name__ == "__main__":
    (serve if sys.argv[2:] == ["serve"] else keep)(Path(sys.argv[1]))
