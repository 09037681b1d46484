"""The commands that run the service, speak to it, and recheck what it stored."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import pytest

from tests.running import Service, command, free_port


@pytest.fixture(scope="module")
def data(tmp_path_factory) -> Path:
    """The service's data folder."""
    return tmp_path_factory.mktemp("data")


@pytest.fixture(scope="module")
def said(data) -> Iterator[str]:
    """The line that `servoident serve` prints, while it runs."""
    arguments = ("--port", free_port(), "--data", data, "--allow-host", "lab.example")
    with command("serve", *arguments, until="token=") as line:
        yield line


@pytest.fixture(scope="module")
def service(said) -> Service:
    """That service, for its clients."""
    return Service.that_said(said)


@pytest.fixture(scope="module")
def stored(service, servoident, matrix) -> dict:
    """The simulated matrix, uploaded by the command."""
    done = servoident("upload", matrix, *service.options, "--json", "-")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def fitted(service, stored) -> str:
    """The id of a finished fit of it."""
    job = service.ended(service.fit(stored["id"], set={"m0": "4.25 kg"}))
    assert job["state"] == "succeeded", job
    return job["fit"]


def test_serve_prints_an_address_on_this_machine_only(said):
    """The loopback address, with a token."""
    assert re.search(r"http://127\.0\.0\.1:\d+/\?token=\S{20,}", said)


@pytest.mark.parametrize(("host", "status"), [("lab.example", 200), ("other.example", 403)])
def test_only_names_that_were_allowed_are_served(service, host, status):
    """A name given with --allow-host works; any other is refused, whatever it resolves to."""
    assert service.client.get("/jobs", headers={"Host": host}).status_code == status


def test_an_uploaded_folder_is_the_matrix(stored, matrix):
    """Every run arrived under its id."""
    assert len(stored["runs"]) == 84
    assert stored["serial"] == "SIM-0001"
    assert (matrix / "runs" / f"{stored['runs'][0]['id']}.npz").exists()


def test_the_same_folder_again_is_known_already(service, servoident, matrix, stored):
    """Nothing is stored twice."""
    done = servoident("upload", matrix, *service.options)
    assert stored["id"] in done.stdout
    assert "known already" in done.stdout


def test_a_revision_is_a_new_matrix_with_the_mended_label(service, servoident, stored, tmp_path):
    """The gain of one run is changed; the first matrix stays."""
    run = stored["runs"][0]["id"]
    (tmp_path / "changes.yaml").write_text(f"runs: {{{run}: {{gain: 9}}}}")
    done = servoident("revise", stored["id"], tmp_path / "changes.yaml", *service.options)
    assert done.returncode == 0, done.stderr
    revised = service.client.get(f"/matrices/{done.stdout.split()[1]}").json()
    assert revised["parent"] == stored["id"]
    assert {one["id"]: one["gain"] for one in revised["runs"]}[run] == 9


def test_an_approved_fit_is_what_a_query_finds_and_what_regress_rechecks(service, data, servoident, fitted, tmp_path):
    """Approve, query by serial and range, recheck: the whole way of a parameter set."""
    assert servoident("approve", fitted, *service.options).returncode == 0
    told = servoident("query", "--serial", "SIM-0001", "--range", "Z0=2e-6:3e-6", *service.options, "--json", "-")
    sets = json.loads(told.stdout)
    assert [one["id"] for one in sets] == [fitted]
    assert sets[0]["current"]
    assert servoident("query", "--range", "Z0=3e-6:", *service.options, "--json", "-").stdout.strip() == "[]"
    assert fitted in servoident("query", *service.options, "--csv", "-").stdout
    assert fitted in servoident("query", *service.options).stdout

    junit = tmp_path / "junit.xml"
    done = servoident("regress", "--data", data, "--junit", junit)
    assert done.returncode == 0, done.stdout + done.stderr
    suite = ElementTree.parse(junit).getroot()
    assert (suite.get("tests"), suite.get("failures"), suite.get("errors")) == ("1", "0", "0")


def test_what_the_service_refuses_is_one_line_and_exit_2(service, servoident):
    """Its problem document becomes the line."""
    done = servoident("approve", "nothing", *service.options)
    assert done.returncode == 2
    assert done.stderr.startswith("servoident: fit: there is no fit 'nothing'")
    assert done.stderr.count("\n") == 1


def test_a_wrong_token_is_told(service, servoident):
    """The remedy names the address that the service printed."""
    done = servoident("query", *service.options[:2], "--token", "guessed")
    assert done.returncode == 2
    assert "token" in done.stderr
    assert done.stderr.count("\n") == 1
