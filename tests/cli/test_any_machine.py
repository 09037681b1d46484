"""A record of any machine, as a user brings it: no model named, and every figure that it has."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import yaml

from app.cli import figure_files
from tests.diagnosis.test_structure_selection import RATE, lag


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """A machine that integrates its voltage, three runs as text files beside a plain description."""
    place = tmp_path_factory.mktemp("machine")
    entries = []
    for run in lag("displacement", integrates=True, levels=15).runs:
        table = np.column_stack([run.channels["command"], 1e3 * run.channels["displacement"]])
        np.savetxt(place / f"{run.id}.csv", table, delimiter=",", header="u,x", comments="")
        channels = {"command": {"column": "u", "unit": "V"}, "displacement": {"column": "x", "unit": "mm"}}
        entries.append(
            {
                "id": run.id,
                "file": f"{run.id}.csv",
                "sample_rate": f"{RATE:g} Hz",
                "hold": "zoh",
                "use": run.use,
                "channels": channels,
            }
        )
    (place / "matrix.yaml").write_text(yaml.safe_dump({"actuator": {"serial": "ANY-1"}, "runs": entries}))
    return place


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_the_model_is_chosen_and_what_cannot_be_drawn_is_named(servoident, folder, tmp_path, monkeypatch):
    """It integrates: no frequency response of its own, no curves of what is missing, but the record in time."""
    monkeypatch.setattr(figure_files, "FORMATS", ("svg",))  # the others: tests/cli/test_commands.py
    done = servoident("fit", folder, "--json", tmp_path / "fit.json")
    assert done.returncode == 0, done.stderr
    fit = json.loads((tmp_path / "fit.json").read_text())
    assert (fit["model"], fit["structures"][0]["machine"]) == ("open_valve", "open_valve")
    assert fit["notes"][0].startswith("No model was named. The first of these was chosen: open_valve, held-out error ")
    done = servoident("compare", folder, "--fit", tmp_path / "fit.json", "--out", tmp_path / "figures")
    assert done.returncode == 0, done.stderr
    assert "cannot be drawn: " in done.stdout
    assert (tmp_path / "figures" / "time.svg").stat().st_size > 1000
