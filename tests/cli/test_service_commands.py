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
    arguments = (
        "--port",
        free_port(),
        "--data",
        data,
        "--allow-host",
        "lab.example",
        "--webhook-host",
        "127.0.0.1:9",
        "--keep-raw",
        "30",
    )
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
    """The id of a finished fit of it; a short search, which each recheck makes again."""
    short = {"population": 40, "generations": 6, "elite": 4}
    job = service.ended(service.fit(stored["id"], set={"m0": "4.25 kg"}, options=short))
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


def test_the_line_s_questions_are_commands(service, servoident, fitted, tmp_path):
    """Limits, a verdict with its exit status, statistics with their chart, a recheck over the workers, withdrawing."""
    servoident("approve", fitted, "--why", "sound", *service.options)
    done = servoident("limits", "qian2014", "--limit", "tau=1:6 ms", "--limit", "error.fit=:50 %", *service.options)
    assert done.returncode == 0, done.stderr
    assert "every  error.fit" in done.stdout
    told = servoident("verdict", "SIM-0001", *service.options)
    assert (told.returncode, told.stdout.partition("\n")[0]) == (0, "SIM-0001: pass")
    servoident("limits", "qian2014", "--batch", "", "--limit", "tau=:1 ms", *service.options)
    told = servoident("verdict", "SIM-0001", *service.options)
    assert told.returncode == 1
    assert "outside the upper limit" in told.stdout
    found = servoident("statistics", "tau", "--serial", "SIM-0001", *service.options)
    assert "Mean" in found.stdout, found.stderr
    junit = tmp_path / "junit.xml"
    done = servoident("regress", "--serial", "SIM-0001", "--junit", junit, *service.options)
    assert done.returncode == 0, done.stdout + done.stderr
    assert ElementTree.parse(junit).getroot().get("tests") == "1"
    assert servoident("withdraw", fitted, "--why", "leaks", *service.options).returncode == 0
    assert "no parameter set is approved" in servoident("verdict", "SIM-0001", *service.options).stdout


def test_a_fit_is_annotated_and_what_no_option_names_stays(service, servoident, fitted):
    done = servoident(
        "annotate", fitted, "--name", "cold oil", "--tag", "acceptance", "--tag", "20 degC", *service.options
    )
    assert done.stdout == f"fit {fitted}: cold oil; tags: acceptance, 20 degC\n", done.stderr
    noted = servoident("annotate", fitted, "--note", "valve 3", "--tag", "", *service.options)
    assert noted.stdout == f"fit {fitted}: cold oil; tags: none\nvalve 3\n"
    assert servoident("annotate", fitted, *service.options).stdout == noted.stdout
    assert servoident("annotate", "nothing", "--name", "x", *service.options).returncode == 2


def test_a_search_lists_what_holds_a_text(service, servoident, fitted):
    shown = servoident("search", fitted[:12], *service.options).stdout
    assert fitted in shown
    assert "SIM-0001" in servoident("search", "sim-0001", *service.options).stdout
    assert servoident("search", "nobody", *service.options).stdout == "nothing holds 'nobody'\n"


def test_a_fit_is_deleted_once_that_is_confirmed(service, servoident, stored):
    short = {"population": 20, "generations": 3, "elite": 2}
    fit = service.ended(service.fit(stored["id"], set={"m0": "4.25 kg"}, options=short))["fit"]
    shown = servoident("delete", fit, *service.options)
    assert shown.stdout == f"fit {fit} of SIM-0001 would be deleted (nothing was made of it); to delete it: --yes\n"
    done = servoident("delete", fit, "--yes", *service.options)
    assert done.stdout == f"fit {fit} of SIM-0001 is deleted (nothing was made of it)\n", done.stderr
    assert servoident("delete", fit, "--yes", *service.options).returncode == 2


def test_what_the_service_refuses_is_one_line_and_exit_2(service, servoident):
    """Its problem document becomes the line."""
    done = servoident("approve", "nothing", *service.options)
    assert done.returncode == 2
    assert done.stderr.startswith("servoident: fit: there is no fit 'nothing'")
    assert done.stderr.count("\n") == 1


def test_a_token_is_made_used_listed_and_revoked(service, data, servoident):
    """By commands, while the service runs: it lets in what its role may, until it is revoked; all of it is noted."""
    made = servoident("token", "new", "--role", "line", "--name", "station 2", "--expires", "90d", "--data", data)
    assert (made.returncode, made.stdout.count("\n")) == (0, 1), made.stderr
    assert "not shown again" in made.stderr
    own = ("--server", service.address, "--token", made.stdout.strip())
    assert servoident("query", *own, "--json", "-").returncode == 0
    refused = servoident("approve", "nothing", *own)
    assert refused.returncode == 2
    assert "a token for line may not do this; use a token for lab" in refused.stderr

    (token,) = json.loads(servoident("token", "list", "--data", data, "--json", "-").stdout)
    assert (token["name"], token["role"], token["state"]) == ("station 2", "line", "valid")
    assert token["last_used_at"] is not None
    assert made.stdout.strip() not in servoident("token", "list", "--data", data).stdout

    assert servoident("token", "revoke", token["id"], "--data", data).returncode == 0
    assert servoident("query", *own).returncode == 2
    assert "revoked" in servoident("token", "list", "--data", data).stdout
    noted = json.loads(servoident("audit", "--object", f"tokens/{token['id']}", "--data", data, "--json", "-").stdout)
    assert [line["action"] for line in noted] == ["revoke_token", "new_token"]
    assert "upload_matrix" in servoident("audit", "--by", "start", "--data", data).stdout


@pytest.mark.parametrize(
    ("arguments", "where"),
    [
        (("new", "--role", "boss", "--name", "x"), "--role"),
        (("new", "--role", "ci", "--name", "a\nb"), "--name"),
        (("new", "--role", "ci", "--name", "x", "--expires", "soon"), "expires"),
        (("revoke", "nothing"), "token"),
    ],
)
def test_a_token_that_cannot_be_is_one_line(servoident, tmp_path, arguments, where):
    done = servoident("token", *arguments, "--data", tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith(f"servoident: {where}: ")
    assert done.stderr.count("\n") == 1


def test_a_proxy_is_an_address(servoident):
    """What would never be believed is refused at the start."""
    done = servoident("serve", "--proxy", "the proxy")
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert "--proxy" in done.stderr


def test_a_wrong_token_is_told(service, servoident):
    """The remedy names the address that the service printed."""
    done = servoident("query", *service.options[:2], "--token", "guessed")
    assert done.returncode == 2
    assert "token" in done.stderr
    assert done.stderr.count("\n") == 1


def test_a_webhook_is_made_listed_and_revoked(service, servoident, stored):
    """Its secret alone is on standard output; what it was sent is listed; other hosts are refused."""
    refused = servoident("webhook", "new", "https://elsewhere.example/", *service.options)
    assert refused.returncode == 2
    assert "no host that webhooks may reach" in refused.stderr
    made = servoident("webhook", "new", "http://127.0.0.1:9/told", "--event", "job.ended", *service.options)
    assert re.fullmatch(r"[\w-]{43}\n", made.stdout), made.stderr
    assert made.stdout.strip() not in made.stderr
    listed = servoident("webhook", "list", *service.options, "--json", "-")
    (one,) = json.loads(listed.stdout)
    assert (one["url"], one["events"], one["revoked_at"]) == ("http://127.0.0.1:9/told", ["job.ended"], None)
    assert "127.0.0.1:9/told" in servoident("webhook", "list", *service.options).stdout
    assert "nothing yet" in servoident("webhook", "deliveries", one["id"], *service.options).stdout
    service.client.delete(f"/jobs/{service.fit(stored['id'], seed=99)}")
    service.ended(service.client.get("/jobs").json()["items"][0]["id"])
    (told,) = json.loads(servoident("webhook", "deliveries", one["id"], *service.options, "--json", "-").stdout)
    assert (told["event"], told["state"]) == ("job.ended", "waiting")
    assert "is revoked" in servoident("webhook", "revoke", one["id"], *service.options).stdout
    assert "dropped" in servoident("webhook", "deliveries", one["id"], *service.options).stdout
    assert servoident("webhook", "revoke", "nothing", *service.options).returncode == 2


def test_retention_is_shown_and_confirmed(service, servoident):
    """Nothing is 30 days old yet; what was not shown is not removed."""
    shown = servoident("retention", "--show", *service.options)
    assert shown.stdout == "nothing is to go that is older than 30 days\n"
    found = json.loads(servoident("retention", *service.options, "--json", "-").stdout)
    wrong = servoident("retention", "--confirm", "0" * 64, *service.options)
    assert (wrong.returncode, "the list of runs to delete has changed" in wrong.stderr) == (2, True)
    assert servoident("retention", "--confirm", found["digest"], *service.options).returncode == 0
    assert servoident("retention", "--show", "--confirm", found["digest"], *service.options).returncode == 2


@pytest.mark.full
def test_a_backup_is_asked_for_from_a_running_service(service, servoident, fitted, tmp_path):
    """As a file that is restored; without its token, none."""
    done = servoident("backup", tmp_path / "all.backup", *service.options)
    assert done.returncode == 0, done.stderr
    restored = servoident("restore", tmp_path / "all.backup", "--data", tmp_path / "new")
    assert restored.returncode == 0, restored.stderr
    assert "fits" in restored.stdout
    assert fitted
    assert servoident("backup", tmp_path / "none", "--server", service.address, "--token", "x").returncode == 2
    assert sorted(file.name for file in tmp_path.iterdir()) == ["all.backup", "new"]
