"""What is added to the program is one file and at most one line elsewhere: shown by doing it in a copy.

So are the changes that CONTRIBUTING.md works out, each with the tests that judge it.
"""

from __future__ import annotations

import ast
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.worked_examples import Change, worked_examples

ROOT = Path(__file__).resolve().parents[1]


ADDITIONS = (
    Change(
        "ident/stages/lagging_spool.py",
        "a new file",
        "",
        '''"""Spool: behind the valve's output by a lag of its own."""

from ident.parameter import Parameter
from ident.stages.scale import Scale
from ident.stages.stage import Quantity, stage

LAGGING_SPOOL = stage(
    "spool",
    (Quantity("w", "m", "spool opening, in the unit of the drive signal"),),
    ("w' = (q - w) / Ts", "first-order lag of the main stage"),
    parameters=(Parameter("Ts", "T_s", "s", 1e-5, 1e-1, 1e-3, "time constant of the main stage"),),
    scales=(Scale("Ts", "tau", 1e-2, 1e1),),
)
''',
    ),
    Change(
        "ident/presets/lagging.py",
        "a new file",
        "",
        '''"""The actuator of Qian et al. (2014) with a lag of the main stage."""

from dataclasses import replace

from ident.presets.qian2014 import QIAN2014
from ident.stages import RIGID_SPOOL
from ident.stages.lagging_spool import LAGGING_SPOOL

_STAGES = tuple(LAGGING_SPOOL if stage is RIGID_SPOOL else stage for stage in QIAN2014.chain.stages)
LAGGING = replace(
    QIAN2014, name="lagging", title="Actuator with a lagging spool", chain=replace(QIAN2014.chain, stages=_STAGES)
)
''',
    ),
    Change("ident/presets/__init__.py", "behind", '    "qian2014",', '    "lagging",\n'),
    Change(
        "ident/readers/columns.py",
        "a new file",
        "",
        '''"""Columns by name in JSON."""

import json

import numpy as np

from ident.readers.limits import Limits
from ident.readers.table import Table


def read_columns(data: bytes, where: str, limits: Limits) -> Table:
    """The columns of a .columns."""
    columns = json.loads(data)
    names = tuple(columns)
    return Table(names, lambda numbers: [np.array(columns[names[number]]) for number in numbers])
''',
    ),
    Change("ident/readers/__init__.py", "behind", '    ".tdms": "tdms",', '    ".columns": "columns",\n'),
    Change(
        "app/greeting/endpoints.py",
        "a new file",
        "",
        '''"""/greeting: who is there."""

from fastapi import APIRouter

from app.access.roles import READERS
from app.errors import COMMON

router = APIRouter(tags=["greeting"], responses=COMMON)


@router.get("/greeting", dependencies=[READERS])
def greeting() -> dict[str, str]:
    """A word."""
    return {"greeting": "hello"}
''',
    ),
    Change("app/main.py", "behind", '    "operation",', '    "greeting",\n'),
)
"""New files, and the line behind another one in the table of what there is; a stage needs none."""

USED = """
import json, sys
from pathlib import Path

import numpy as np
from fastapi.testclient import TestClient

from app.main import create_app
from app.pages.figure_forms import forms
from app.settings import Settings as ServiceSettings
from ident import Settings, figure, identify, read_matrix
from ident.figures import render
from ident.presets import preset
from ident.synthesis.matrix import simulate_matrix

folder = Path(sys.argv[1])
simulate_matrix(folder / "plain", "lagging", seconds=0.25, small=True)
simulate_matrix(folder / "damped", "lagging", seconds=0.25, small=True, effects={"cubic_damping": 2e5})
plain, damped = (read_matrix(folder / name) for name in ("plain", "damped"))

for name in (folder / "plain" / "runs").glob("*.npz"):
    name.with_suffix(".json").write_text(json.dumps({key: list(x) for key, x in np.load(name).items()}))
description = folder / "plain" / "matrix.yaml"
description.write_text(description.read_text().replace(".npz", ".json"))
columns = read_matrix(folder / "plain")

def held(matrix, *effects, **given):  # a fit whose every parameter is held: what the model makes of the data
    values = {parameter.name: parameter.value for parameter in preset("lagging", effects).parameters}
    return identify(matrix, Settings(model="lagging", effects=effects, fixed=values | given))

fits = {
    "plain": held(plain), "short": held(plain, Ts=1e-4),
    "damped": held(damped, "cubic_damping", cubic_damping=2e5),
}
model = preset("lagging", ("cubic_damping",))
token = "a-token"
client = TestClient(create_app(ServiceSettings(data=folder / "data", token=token)), "http://127.0.0.1:8000",
                    headers={"Authorization": f"Bearer {token}"})
print(json.dumps({
    "moved": max(float(np.std(a.measured - b.measured) / np.std(a.measured)) for a, b in zip(plain.runs, damped.runs)),
    "same": all(np.array_equal(a.measured, b.measured) for a, b in zip(plain.runs, columns.runs)),
    "errors": {name: fit.error["fit"] for name, fit in fits.items()},
    "fields": {field.label: [said for _, said in field.choices]
               for form in forms((), fits["plain"]) if form.name == "counted-residuals" for field in form.fields},
    "figure": json.loads(render(figure(fits["plain"], "counted-residuals", bins=7), "json")),
    "parameters": [parameter.name for parameter in model.parameters],
    "scales": [scale.name for scale in model.scales],
    "models": client.get("/api/v1/models").json(),
    "effects": client.get("/api/v1/effects").json(),
    "greeting": client.get("/api/v1/greeting").json(),
}))
"""
"""What a user does with the additions, through the face of the library and over HTTP."""


_OF_EFFECTS = "tests/effects/test_contract.py tests/reference/test_nonlinear_reference.py"
_OF_EVIDENCE = ("test_rule", "test_evidence", "test_sentences")
EXAMPLES = {
    "An effect of the load": f"{_OF_EFFECTS} -k cubic_damping",
    "An effect of the valve": f"{_OF_EFFECTS} -k gain_growth",
    "The rule by which an effect is added": " ".join(f"tests/diagnosis/{name}.py" for name in _OF_EVIDENCE),
    "A figure with an option": "tests/figures/test_figures.py -k histogram",
    "A field that an endpoint answers": "tests/app/test_matrix_views.py",
}
"""The tests that judge each example of CONTRIBUTING.md."""


def test_each_example_quotes_one_line_and_names_files_that_are_new():
    for heading, changes in worked_examples().items():
        assert bool(changes) == (heading in EXAMPLES), heading
        for change in changes:
            file = ROOT / change.file
            if change.how == "a new file":
                assert not file.exists(), file
            else:
                lines = file.read_text(encoding="utf-8").splitlines()
                assert len(change.places(lines)) == 1, f"{heading}: {change.line} in {file}"
            if file.suffix == ".py" and change.how == "a new file":
                ast.parse(change.text)


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the program with all additions and all examples of CONTRIBUTING.md."""
    copy = tmp_path_factory.mktemp("copy")
    for name in ("ident", "app", "schemas", "migrations", "tests", "docs"):
        shutil.copytree(ROOT / name, copy / name)  # with what was compiled of them
    shutil.copy(ROOT / "pyproject.toml", copy)
    for change in (*ADDITIONS, *(change for changes in worked_examples().values() for change in changes)):
        change.put_into(copy)
    return copy


@pytest.mark.full
@pytest.mark.parametrize("example", EXAMPLES)
def test_an_example_passes_its_tests(copy, example):
    called = [sys.executable, "-m", "pytest", *EXAMPLES[example].split()]
    own = os.environ | {"PYTHONPATH": str(copy)}
    done = subprocess.run(called, cwd=copy, env=own, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-3000:]


@pytest.fixture(scope="module")
def found(copy: Path, tmp_path_factory: pytest.TempPathFactory) -> dict:
    """What was found with all additions in a process of its own."""
    used = copy / "used.py"
    used.write_text(USED, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, str(used), str(tmp_path_factory.mktemp("used"))],
        cwd=copy,
        env=os.environ | {"PYTHONPATH": str(copy)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


@pytest.mark.full
def test_an_effect(found):
    """It is in the catalogue where its line says, it is simulated, and a model that has it explains the data."""
    names = [effect["name"] for effect in found["effects"]]
    assert names[names.index("quadratic_damping") + 1] == "cubic_damping"
    assert found["moved"] > 0.02
    assert found["errors"]["damped"] < 0.01


@pytest.mark.full
def test_a_stage(found):
    """What it brings is in the model that has it, in its turn of the search, and acts."""
    assert found["parameters"] == ["Z0", "tau", "Cl", "c0", "m0", "Ka", "Ts", "cubic_damping.coefficient"]
    assert found["scales"][-2:] == ["Ts", "cubic_damping__coefficient"]
    assert found["errors"]["plain"] < 0.01 < found["errors"]["short"]


@pytest.mark.full
def test_a_preset(found):
    """It is listed by its name, with its equations, and simulated."""
    (listed,) = (model for model in found["models"] if model["name"] == "lagging")
    assert any("Ts" in equation["text"] for equation in listed["equations"])


@pytest.mark.full
def test_a_figure(found):
    """It is drawn by its name, by its option; the page has a field for that."""
    assert sorted(len(rows) for rows in found["figure"]["datasets"].values()) == [1, 7]
    assert found["fields"] == {"Number of bins": []}


@pytest.mark.full
def test_a_reader(found):
    """A file of its ending is read as the same samples."""
    assert found["same"]


@pytest.mark.full
def test_an_endpoint(found):
    assert found["greeting"] == {"greeting": "hello"}
