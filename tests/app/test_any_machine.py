"""A machine of another kind over HTTP: no model is named, that which fits is taken, and the page says so."""

from __future__ import annotations

import io
import zipfile

import numpy as np
import pytest
import yaml

from tests.app.conftest import zipped
from tests.app.test_bench import API, ended
from tests.presets.test_machines import RATE, motor

OPTIONS = {"population": 16, "generations": 4, "elite": 3}


@pytest.fixture(scope="module")
def matrix(service) -> str:
    """The id of an uploaded motor in open loop: volts in, rpm out."""
    entries, packed = [], io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for run in motor(11).runs:
            table = np.column_stack([run.channels["command"], run.channels["velocity"] * 60 / (2 * np.pi)])
            text = io.StringIO()
            np.savetxt(text, table, delimiter=",", header="u,n", comments="")
            archive.writestr(f"{run.id}.csv", text.getvalue())
            channels = {"command": {"column": "u", "unit": "V"}, "velocity": {"column": "n", "unit": "rpm"}}
            entries.append({"id": run.id, "file": f"{run.id}.csv", "sample_rate": f"{RATE:g} Hz", "hold": "zoh",
                            "output": "velocity", "use": run.use, "channels": channels})  # fmt: skip
        archive.writestr("matrix.yaml", yaml.safe_dump({"actuator": {"serial": "ANY-2"}, "runs": entries}))
    answer = service.post(f"{API}/matrices", files={"files": ("any.zip", packed.getvalue())})
    assert answer.status_code == 201, answer.text
    return str(answer.json()["id"])


@pytest.mark.usefixtures("few_effects")
def test_without_a_model_that_which_fits_is_taken_and_the_others_are_told(service, matrix):
    job = ended(service, service.post(f"{API}/fits", json={"matrix": matrix, "options": OPTIONS}))
    fit = service.get(f"{API}/fits/{job['fit']}").json()["result"]
    assert fit["model"] == fit["settings"]["model"] == "motor"
    assert fit["structures"][0]["machine"] == "motor"
    assert len(fit["structures"]) == 2  # an electric drive has no oil
    assert fit["notes"][0].startswith("No model was named. The first of these was chosen: motor, held-out error ")
    assert service.get(f"/fits/{job['fit']}").status_code == 200
    assert "<td>motor</td>" in service.get(f"/matrices/{matrix}").text  # the list of fits


def test_what_belongs_to_a_model_is_taken_for_the_likeliest(service, matrix):
    answer = service.post(f"{API}/fits", json={"matrix": matrix, "effects": ["dead_zone"], "options": OPTIONS})
    job = ended(service, answer)
    assert job["settings"]["model"] == "motor"
    assert service.get(f"{API}/fits/{job['fit']}").json()["result"]["effects"] == ["dead_zone"]


def test_a_matrix_of_the_papers_kind_has_its_model_by_name(service):
    """As before: nothing is compared where the channels say what the machine is."""
    answer = service.post(f"{API}/matrices", files={"files": ("matrix.zip", zipped("ANY-3"))})
    wanted = {"matrix": answer.json()["id"], "options": OPTIONS}
    assert service.post(f"{API}/fits", json=wanted).json()["settings"]["model"] == "qian2014"


def test_the_page_offers_the_choice_and_the_effects_that_it_may_take(service, matrix):
    page = service.get(f"/matrices/{matrix}").text
    assert '<option value="">Select automatically</option>' in page
    assert "The model that fits of 2 that the channels allow" in page
    assert 'value="dead_zone"' in page
    assert 'value="pressure_feedback"' not in page  # of a valve-controlled cylinder
    assert "second_lag" not in page.split("Physical effects to add")[1].split("</details>")[0]
