"""What a new user starts with: a sound actuator, one with hidden effects, and the way from its failing fit to noise."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from app.cli.demo import LACKING, SOUND, begin, wanted
from tests.running import CHROMIUM, LITTLE, Service, command, free_port


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The data folder of a lab's own service."""
    return tmp_path_factory.mktemp("lab")


@pytest.fixture(scope="module")
def demo(data: Path, full: bool) -> Iterator[Service]:
    """The demo of a user whose service keeps its data there, as soon as it prints its address."""
    with pytest.MonkeyPatch.context() as own:
        own.setenv("SERVOIDENT_DATA", str(data))
        with command("demo", "--port", free_port(), until="token=", first="" if full else LITTLE) as line:
            yield Service.that_said(line)


@pytest.fixture(scope="module")
def fits(demo: Service) -> dict[str, dict[str, Any]]:
    """The first fit of each actuator, by serial number."""
    ended = [demo.ended(job["id"]) for job in demo.client.get("/jobs").json()["items"]]
    return {job["serial"]: demo.client.get(f"/fits/{job['fit']}").json() for job in ended}


def over_the_floor(fit: dict[str, Any], use: str) -> float:
    """The error of a fit as a multiple of its noise floor."""
    return float(fit["result"]["error"][use] / fit["result"]["noise_floor"][use])


@pytest.mark.usefixtures("demo")
def test_the_demo_keeps_out_of_the_data_of_the_service(data):
    """It has a folder of its own inside."""
    assert [path.name for path in data.iterdir()] == ["demo"]
    assert (data / "demo" / "servoident.sqlite").exists()


def test_the_demo_starts_with_a_sound_actuator_and_one_whose_fit_visibly_fails(request, full):
    """Both are identified by themselves and called simulated; only the second is far above its noise."""
    if not full and shutil.which(CHROMIUM):
        pytest.skip("the story of tests/browser/test_workbench.py begins with the same: here with --full")
    demo, fits = request.getfixturevalue("demo"), request.getfixturevalue("fits")
    assert {"SIM-0001", "SIM-0002"} == set(fits) == {SOUND.serial, LACKING.serial}
    assert all(one["name"].startswith("simulated") for one in demo.client.get("/actuators").json()["items"])
    for use in ("fit", "verify"):
        assert over_the_floor(fits[SOUND.serial], use) < 1.05
        assert over_the_floor(fits[LACKING.serial], use) > 10


def test_what_was_hidden_is_named_and_once_it_is_added_the_error_is_noise(request, full):
    """The diagnosis of the failing fit names exactly the hidden effects, with their strengths, and no other."""
    if not full and shutil.which(CHROMIUM):
        pytest.skip("the story of tests/browser/test_workbench.py does the same by button: here with --full")
    demo, fits = request.getfixturevalue("demo"), request.getfixturevalue("fits")
    fit = fits[LACKING.serial]["id"]
    job = demo.client.post("/diagnoses", json={"fit": fit}).json()["id"]
    assert demo.ended(job)["state"] == "succeeded"
    found = demo.client.get(f"/diagnoses/{job}").json()["verdict"]
    hidden = {name.partition(".")[0] for name in LACKING.hidden}
    assert set(found["effects"]) == hidden
    assert not found["unexplained"]
    assert not found["suspects"]

    queued = demo.client.post(f"/fits/{fit}/effects", json={"effects": found["effects"]}).json()["id"]
    mended = demo.client.get(f"/fits/{demo.ended(queued)['fit']}").json()
    for use in ("fit", "verify"):
        assert over_the_floor(mended, use) < 1.05
    for name, strength in LACKING.hidden.items():
        assert mended["result"]["parameters"][name]["value"] == pytest.approx(strength, rel=0.03)


@pytest.mark.usefixtures("fits")
def test_a_second_start_adds_nothing(demo, capsys):
    """The actuators are there, so nothing is simulated, stored or queued again."""
    before = demo.client.get("/jobs").json(), demo.client.get("/matrices").json()
    begin(demo.address, demo.token)
    assert (demo.client.get("/jobs").json(), demo.client.get("/matrices").json()) == before
    assert "as you left them" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("there", "added"),
    [
        ((), (SOUND, LACKING)),
        (("SIM-0001",), (LACKING,)),
        (("SIM-0001", "SIM-0002", "SW-7"), ()),
        (("DEMO-0001",), (LACKING,)),
        (("SW-7",), ()),
        (("SW-7", "DEMO-0001"), (LACKING,)),
    ],
)
def test_a_data_folder_is_not_disturbed(there, added):
    """None is added twice, the one of an earlier version counts as the sound one, a lab's own folder stays its own."""
    assert wanted(there) == added
