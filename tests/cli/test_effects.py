"""Effects of one's own that are kept on this machine, and by a service, through the command line."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest

from ident.diagnosis.discovery.proposal import Proposal
from ident.diagnosis.result import Diagnosis, Verdict
from tests.running import Service, process

LAPPED = """
place: spool
equation: w = w - clip(w, -h, h)
strength: {symbol: h, unit: mm, lower: 0, upper: 1}
meaning: the lands overlap
"""
LEAK = {
    "name": "proposed_1",
    "place": "flow",
    "equation": ["Q = Q + s * (abs(P))"],
    "strength": {"symbol": "s", "unit": "m^3/(s*Pa)", "lower": -1e-10, "upper": 1e-10},
    "meaning": "proposed by search",
    "source": "proposed by search",
}
TERM = Proposal(
    place=("flow",),
    equation="Q = Q + s * (abs(P))",
    effect=LEAK,
    nats=25.0,
    bar=17.0,
    alike=("Q: max(P, 0)",),
    meaning="leakage in one direction: the leak differs with the sign of the pressure",
)


@pytest.fixture(autouse=True)
def data(tmp_path, monkeypatch) -> Path:
    """A data folder of each test's own."""
    monkeypatch.setenv("SERVOIDENT_DATA", str(tmp_path / "data"))
    return tmp_path / "data"


@pytest.fixture
def lapped(tmp_path) -> Path:
    """The file of an effect."""
    file = tmp_path / "lapped.yaml"
    file.write_text(LAPPED)
    return file


@pytest.fixture
def diagnosis(tmp_path) -> Path:
    """The JSON of a diagnosis that proposes one term."""
    file = tmp_path / "D.json"
    found = Diagnosis(candidates=(), verdict=Verdict(), proposals=(TERM,), version="0.1.0", data_hash="abc")
    file.write_text(json.dumps(found.to_json()))
    return file


@pytest.fixture(scope="module")
def service(tmp_path_factory) -> Iterator[Service]:
    """A service, whose own effects are not those of this machine."""
    with process(tmp_path_factory.mktemp("service")) as running:
        yield running


def listed(servoident, *options: str) -> dict:
    """What `servoident effects` lists, by name."""
    done = servoident("effects", "--json", "-", *options)
    assert done.returncode == 0, done.stderr
    return {one["name"]: one for one in json.loads(done.stdout)["own"]}


def refused(done, *said: str) -> None:
    """One line on standard error, exit status 2."""
    assert done.returncode == 2, done.stdout
    assert done.stderr.count("\n") == 1, done.stderr
    assert all(text in done.stderr for text in said), done.stderr


def test_an_effect_is_kept_listed_and_dropped(servoident, lapped, data):
    """In the data folder of the user, called after its file; the catalogue stands beside it."""
    assert "no own effects yet" in servoident("effects").stdout
    done = servoident("effects", "keep", lapped)
    assert done.returncode == 0, done.stderr
    assert "lapped is saved" in done.stdout
    assert (data / "effects" / "lapped.json").is_file()
    assert "was already saved" in servoident("effects", "keep", lapped).stdout
    told = servoident("effects").stdout
    for text in ("lapped", "w = w - clip(w, -h, h)", "the lands overlap", "written", "coulomb_friction"):
        assert text in told
    kept = listed(servoident)["lapped"]
    assert (kept["origin"], kept["place"], kept["model"]) == ("written", "spool", None)
    assert kept["created_at"]
    assert servoident("effects", "drop", "lapped").returncode == 0
    assert listed(servoident) == {}
    refused(servoident("effects", "drop", "lapped"), "lapped: no effect is saved under this name")


def test_another_effect_does_not_take_the_name(servoident, lapped):
    servoident("effects", "keep", lapped)
    lapped.write_text(LAPPED.replace("w - clip", "w - 2 * clip"))
    refused(servoident("effects", "keep", lapped), "another effect is saved as lapped", "drop lapped")
    assert servoident("effects", "keep", lapped, "--name", "twice_lapped").returncode == 0
    assert listed(servoident).keys() == {"lapped", "twice_lapped"}


def test_a_kept_effect_is_named_without_its_file(servoident, few, lapped, tmp_path):
    """A file of the same name comes first; a name that is not kept is refused."""
    servoident("effects", "keep", lapped)
    fitted = tmp_path / "fit.json"
    asked = ("--model", "qian2014", "--option", "generations=1", "--json", fitted)
    done = servoident("fit", few, "--custom", "lapped", *asked)
    assert done.returncode == 0, done.stderr
    fit = json.loads(fitted.read_text())
    assert fit["effects"] == ["lapped"]
    assert fit["settings"]["custom"][0]["equation"] == "w = w - clip(w, -h, h)"
    refused(servoident("fit", few, "--custom", "loped", *asked), "loped: no effect is saved", "did you mean lapped?")


def test_a_diagnosis_ranks_what_is_kept_where_it_is_asked_to(lapped, servoident):
    """Beside what it was given, which comes first; what the model cannot take is left out."""
    from app.cli.local_effects import beside

    servoident("effects", "keep", lapped)
    given = {"name": "lapped", "meaning": "given"}
    assert [one["meaning"] for one in beside((), "qian2014")] == ["the lands overlap"]
    assert beside((given,), "qian2014") == (given,)
    assert beside((), "drive") == ()


@pytest.mark.usefixtures("few_effects")
def test_diagnose_own_ranks_what_is_kept(servoident, few, fit_file, lapped):
    servoident("effects", "keep", lapped)
    asked = ("diagnose", few, "--fit", fit_file, "--max-effects", 1, "--json", "-")
    for own in ((), ("--own",)):
        done = servoident(*asked, *own)
        assert done.returncode == 0, done.stderr
        ranked = {one["effect"] for one in json.loads(done.stdout)["candidates"]}
        assert ("lapped" in ranked) == bool(own)


def test_a_file_comes_before_what_is_kept_under_its_name(lapped, tmp_path, monkeypatch, servoident):
    from app.cli.arguments import definitions

    servoident("effects", "keep", lapped)
    monkeypatch.chdir(tmp_path)
    assert definitions([Path("lapped")])[0]["meaning"] == "the lands overlap"
    Path("lapped").write_text(LAPPED.replace("the lands overlap", "of the file"))
    assert definitions([Path("lapped")])[0]["meaning"] == "of the file"


def test_a_proposed_term_is_kept_with_where_it_comes_from(servoident, diagnosis):
    """Under the name that is given, and the refusal suggests one."""
    refused(servoident("effects", "keep", diagnosis), "no name yet", "--name leakage_in_one_direction")
    done = servoident("effects", "keep", diagnosis, "--name", "leak", "--proposal", 1)
    refused(done, "of 1 terms none is number 1", "give 0 to 0")
    assert servoident("effects", "keep", diagnosis, "--name", "leak").returncode == 0
    kept = listed(servoident)["leak"]
    assert (kept["definition"]["name"], kept["definition"]["equation"]) == ("leak", LEAK["equation"])
    assert (kept["origin"], kept["meaning"], kept["model"]) == ("proposed by search", TERM.meaning, "qian2014")
    assert (kept["nats"], kept["bar"], kept["class"], kept["data_hash"]) == (25.0, 17.0, list(TERM.alike), "abc")
    assert "proposed by search" in servoident("effects").stdout


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("keep", "nowhere.yaml"), "nowhere.yaml"),
        (("keep", "LAPPED", "--name", "dead_zone"), "the effect library has an effect dead_zone"),
        (("keep", "LAPPED", "--name", "tau"), "tau is the time constant"),
        (("keep", "LAPPED", "--name", "../x"), "is not a name of an effect"),
        (("drop", "../x"), "is not a name of an effect"),
        (("keep",), "missing argument"),
        (("--json", "-", "keep", "LAPPED"), "an option is before the command keep"),
        (("--server", "http://127.0.0.1:9"), "no answer"),
        (("keep", "nothing", "--server", "http://127.0.0.1:9"), "--name"),
    ],
)
def test_what_cannot_be_done_is_one_line(servoident, lapped, arguments, said):
    refused(servoident("effects", *(lapped if one == "LAPPED" else one for one in arguments)), said)


def test_a_spoilt_file_is_named(servoident, lapped, data):
    servoident("effects", "keep", lapped)
    (data / "effects" / "lapped.json").write_text('{"name": "other"}')
    refused(servoident("effects"), "lapped.json", "not a saved effect")


@pytest.mark.full
def test_a_service_keeps_what_this_machine_has(servoident, service, lapped, diagnosis):
    """A file, and what is kept here under its name, which still says where it comes from; here nothing changes."""
    assert servoident("effects", "keep", diagnosis, "--name", "leak").returncode == 0
    for source in (lapped, "leak"):
        done = servoident("effects", "keep", source, *service.options)
        assert done.returncode == 0, done.stderr
        assert f"is saved by {service.address}" in done.stdout
    assert "was already saved" in servoident("effects", "keep", "leak", *service.options).stdout
    there = listed(servoident, *service.options)
    assert there.keys() == {"lapped", "leak"}
    assert (there["leak"]["origin"], there["leak"]["model"]) == ("proposed by search", "qian2014")
    assert listed(servoident).keys() == {"leak"}
    done = servoident("effects", "keep", "none-such", "--name", "x1", *service.options)
    refused(done, "there is no diagnosis 'none-such'")
    assert servoident("effects", "drop", "lapped", *service.options).returncode == 0
    assert listed(servoident, *service.options).keys() == {"leak"}
    refused(servoident("effects", "drop", "lapped", *service.options), "there is no own-effect 'lapped'")


def test_the_signals_of_a_model_are_listed(servoident):
    """With what an equation of one's own may change, and as JSON."""
    assert "valve_second_order" in servoident("effects", "--signals", "qian2014").stdout
    listed = json.loads(servoident("effects", "--signals", "kononykhin", "--json", "-").stdout)
    assert {one["name"]: one["place"] for one in listed}["P"] == "load"
    assert "did you mean qian2014" in servoident("effects", "--signals", "qian201").stderr
