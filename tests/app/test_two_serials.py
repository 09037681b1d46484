"""Fits of several actuators side by side, and of one that was fitted again: each is called what it is."""

from __future__ import annotations

import json
import re
from itertools import permutations
from typing import Any

import pytest

from app.client import Client
from tests.app.conftest import zipped

API = "/api/v1"
QUICK = {"options": {"population": 20, "generations": 2}}
ONE, OTHER = "BESIDE-1", "BESIDE-2"


@pytest.fixture(scope="module")
def lab(service) -> Client:
    """A client of the service."""
    return Client("http://127.0.0.1:8000", http=service)


@pytest.fixture(scope="module")
def fits(service, lab) -> dict[str, list[str]]:
    """By serial number: two fits of one actuator, the second far better, and one of another with the same runs."""
    found: dict[str, list[str]] = {}
    for serial, chosen in ((ONE, ({"set": {"tau": "9 ms"}}, {})), (OTHER, ({},))):
        matrix = service.post(f"{API}/matrices", files={"files": ("m.zip", zipped(serial))}).json()["id"]
        found[serial] = [lab.fit(matrix, **QUICK, **one).id for one in chosen]
    return found


def both_ways(fits: dict[str, list[str]]) -> list[tuple[str, ...]]:
    """The fits of two actuators in either order."""
    return list(permutations((fits[ONE][1], fits[OTHER][0])))


def test_http_says_whose_fit_each_column_is(service, fits):
    for pair in both_ways(fits):
        found: dict[str, Any] = service.get(f"{API}/fits/{pair[0]}/beside", params={"other": pair[1]}).json()
        told = {one["fit"]: one["serial"] for one in found["fits"]}
        assert list(told) == list(pair)
        assert told == {fits[ONE][1]: ONE, fits[OTHER][0]: OTHER}


def test_the_figure_bears_both_serial_numbers_and_each_of_its_fits_its_own(service, fits):
    for pair in both_ways(fits):
        chart = json.loads(
            service.get(f"{API}/fits/{pair[0]}/figures/side-by-side.json", params={"other": pair[1]}).content
        )
        first, second = (ONE, OTHER) if pair[0] == fits[ONE][1] else (OTHER, ONE)
        assert chart["title"]["text"].startswith(f"{first} and {second} · ")
        called = {row["f"] for row in chart["datasets"]["errors"]}
        assert {name.split(",")[0] for name in called} == {f"A: {first}", f"B: {second}"}
    alone = service.get(f"{API}/fits/{fits[ONE][0]}/figures/side-by-side.json", params={"other": fits[ONE][1]})
    chart = json.loads(alone.content)
    assert chart["title"]["text"].startswith(f"{ONE} · ")
    assert all(ONE not in row["f"] for row in chart["datasets"]["errors"])


def test_the_page_bears_both_serial_numbers(service, fits):
    """Two fits and three; and runs of one actuator are never drawn with the model of another, though named alike."""
    for pair in both_ways(fits):
        page = service.get("/compare", params={"fits": ",".join(pair)}).text
        assert f"<title>Two fits of {ONE} and {OTHER}" in page
        assert f'href="/actuators/{OTHER}"' in page
        assert "one plot cannot show both" in page
    three = service.get("/compare", params={"fits": ",".join((*fits[OTHER], *fits[ONE]))}).text
    assert f"<title>3 fits of {ONE} and {OTHER}" in three
    assert three.count(f"<td>{ONE}</td>") == 2
    assert three.count(f"<td>{OTHER}</td>") == 1


def test_an_improvement_reads_as_a_fall_whichever_fit_was_picked_first(service, fits):
    """A is the older fit; no error is some hundred per cent more than another."""
    old, new = fits[ONE]
    pages = [service.get("/compare", params={"fits": ",".join(pair)}).text for pair in ((old, new), (new, old))]
    assert pages[0] == pages[1]
    assert pages[0].index(f'<h2><a href="/fits/{old}">A: ') < pages[0].index(f'<h2><a href="/fits/{new}">B: ')
    row = re.search(r"<th scope=\"row\">Error, estimation data</th>(.*?)</tr>", pages[0], re.DOTALL)
    assert row is not None
    assert re.search(r">−\d+\.\d+ points, ÷ \d", row[1])
    runs = re.findall(r'data-value="(-?[\d.e-]+)">(−[\d.]+ points, ÷ [\d.]+)</td>', pages[0])
    assert len(runs) > 5
    assert all(float(value) < 0 for value, _ in runs)
    assert not re.search(r"[+>]\d{3,}\.\d %", pages[0])


@pytest.mark.full
def test_the_command_line_says_whose_fit_each_column_is(service, servoident, fits, tmp_path):
    from tests.app.conftest import files, unpacked

    matrix = unpacked(files(ONE), tmp_path / "matrix")
    paths = []
    for serial in (ONE, OTHER):
        paths.append(tmp_path / f"{serial}.json")
        result = service.get(f"{API}/fits/{fits[serial][-1]}").json()["result"]
        paths[-1].write_text(json.dumps(result))
    out, told = tmp_path / "out", tmp_path / "told.json"
    done = servoident("compare", matrix, "--fit", paths[0], "--fit", paths[1], "--json", told, "--out", out)
    assert done.returncode == 0, done.stderr
    assert [one["serial"] for one in json.loads(told.read_text())["fits"]] == [ONE, OTHER]
    assert f"A: {ONE}, qian2014" in done.stdout
    assert f"B: {OTHER}, qian2014" in done.stdout
    assert f"{ONE} and {OTHER}" in (out / "side-by-side.svg").read_text()


def line(service, serial: str) -> str:
    """What the first page says of an actuator."""
    page = service.get("/", params={"q": serial}).text
    found = re.search(r'<td class="next"[^>]*>(.*?)</td>', page, re.DOTALL)
    assert found is not None
    return " ".join(re.sub(r"<[^>]+>", " ", found[1]).split())


def test_the_first_page_judges_by_the_approved_set_and_tells_of_newer_fits(service, lab):
    """Whether the fit that comes after it is worse or better, and until one of them is approved."""
    matrix = service.post(f"{API}/matrices", files={"files": ("m.zip", zipped("BESIDE-3"))}).json()["id"]
    middling = lab.fit(matrix, **QUICK, set={"tau": "4.5 ms"})
    assert "times the noise floor" in line(service, "BESIDE-3")
    lab.approve(middling.id, "as it is")
    assert line(service, "BESIDE-3").startswith("Approved. No action needed.")
    worse = lab.fit(matrix, **QUICK, set={"tau": "9 ms"})
    better = lab.fit(matrix, **QUICK)
    errors = [one.result.error["verify"] for one in (worse, middling, better)]
    assert errors == sorted(errors, reverse=True)
    told = line(service, "BESIDE-3")
    assert told.startswith("Approved, with an error of ")
    assert "A newer fit has " in told
    assert told.endswith("Compare fits")
    assert "times the noise floor" not in told
    page = service.get("/", params={"q": "BESIDE-3"}).text
    assert f'href="/compare?fits={middling.id},{better.id}" class="button' in page
    lab.approve(worse.id, "a mistake")  # both newer fits were there: nothing new has come since
    assert line(service, "BESIDE-3").startswith("Approved. No action needed.")
    lab.approve(better.id, "it is better")
    assert line(service, "BESIDE-3").startswith("Approved. No action needed.")
