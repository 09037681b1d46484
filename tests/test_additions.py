"""What is added to the program is one file and at most one line elsewhere: shown by doing it in a copy."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

pytestmark = pytest.mark.full
ROOT = Path(__file__).resolve().parents[1]


@dataclass(frozen=True)
class Addition:
    """A new file, and the line that is put behind another one in the table of what there is; a stage needs none."""

    file: str
    text: str
    table: str = ""
    behind: str = ""
    line: str = ""

    def put_into(self, copy: Path) -> None:
        """Write the file, which is new, and the line, behind the only one like that."""
        file = copy / self.file
        file.parent.mkdir(exist_ok=True)
        with file.open("x", encoding="utf-8") as new:
            new.write(self.text)
        if self.table:
            table = copy / self.table
            before, found, after = table.read_text(encoding="utf-8").partition(self.behind + "\n")
            assert found
            assert self.behind not in after
            table.write_text(f"{before}{found}{self.line}\n{after}", encoding="utf-8")


ADDITIONS = {
    "effect": Addition(
        "ident/effects/bypass.py",
        '''"""A share of the load flow goes past the piston."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

BYPASS = Effect(
    name="bypass",
    place="flow",
    meaning="a share of the load flow goes past the piston",
    strength=Parameter("share", "b", "1", -0.5, 0.5, 0.0, "share of the load flow that is lost"),
    texts=("Q = Q * (1 - b)",),
    units={"Q": "m^3/s"},
)
''',
        "ident/effects/__init__.py", '    "underlap",', '    "bypass",',
    ),
    "stage": Addition(
        "ident/stages/lagging_spool.py",
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
    "preset": Addition(
        "ident/presets/lagging.py",
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
        "ident/presets/__init__.py", '    "qian2014",', '    "lagging",',
    ),
    "figure": Addition(
        "ident/figures/error_bars.py",
        '''"""The error of each run as a bar."""

import altair as alt

from ident.figures.drawing import Drawing, Option, Options
from ident.figures.look import Look
from ident.figures.render import Chart
from ident.figures.study import Study


def _drawn(study: Study, look: Look, options: Options) -> Chart:
    rows = [{"run": each.run.id, "error": each.error} for each in study.compared(study.matrix.runs).runs]
    x = alt.X("run:N", sort="y" if options.get("order") == "error" else None)
    chart: Chart = alt.Chart(alt.InlineData(values=rows)).mark_bar().encode(x=x, y="error:Q")
    return chart.configure(**look.config())


_ORDER = Option("order", "Order", str | None, lambda _: (("", "as recorded"), ("error", "by error")))
ERROR_BARS = Drawing("error-bars", "Errors", Study, _drawn, (_ORDER,))
''',
        "ident/figures/__init__.py", '    "evolution",', '    "error_bars",',
    ),
    "reader": Addition(
        "ident/readers/columns.py",
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
        "ident/readers/__init__.py", '    ".tdms": "tdms",', '    ".columns": "columns",',
    ),
    "endpoint": Addition(
        "app/greeting/endpoints.py",
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
        "app/main.py", '    "operation",', '    "greeting",',
    ),
}  # fmt: skip

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
simulate_matrix(folder / "bypassed", "lagging", seconds=0.25, small=True, effects={"bypass": 0.2})
plain, bypassed = (read_matrix(folder / name) for name in ("plain", "bypassed"))

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
    "bypassed": held(bypassed, "bypass", bypass=0.2),
}
model = preset("lagging", ("bypass",))
token = "a-token"
client = TestClient(create_app(ServiceSettings(data=folder / "data", token=token)), "http://127.0.0.1:8000",
                    headers={"Authorization": f"Bearer {token}"})
print(json.dumps({
    "moved": float(np.std(plain.runs[0].measured - bypassed.runs[0].measured) / np.std(plain.runs[0].measured)),
    "same": all(np.array_equal(a.measured, b.measured) for a, b in zip(plain.runs, columns.runs)),
    "errors": {name: fit.error["fit"] for name, fit in fits.items()},
    "fields": {field.label: [said for _, said in field.choices]
               for form in forms((), fits["plain"]) if form.name == "error-bars" for field in form.fields},
    "figure": json.loads(render(figure(fits["plain"], "error-bars", order="error"), "json")),
    "parameters": [parameter.name for parameter in model.parameters],
    "scales": [scale.name for scale in model.scales],
    "models": client.get("/api/v1/models").json(),
    "effects": client.get("/api/v1/effects").json(),
    "greeting": client.get("/api/v1/greeting").json(),
}))
"""
"""What a user does with the additions, through the face of the library and over HTTP."""


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> dict:
    """A copy of the packages with all additions, and what was found with them in a process of its own."""
    copy = tmp_path_factory.mktemp("copy")
    for package in ("ident", "app", "schemas", "migrations"):
        shutil.copytree(ROOT / package, copy / package)  # with what was compiled of them
    for addition in ADDITIONS.values():
        addition.put_into(copy)
    used = copy / "used.py"
    used.write_text(USED, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, str(used), str(tmp_path_factory.mktemp("used"))],
        cwd=copy, env=os.environ | {"PYTHONPATH": str(copy)}, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


def test_an_effect(found):
    """It is in the catalogue where its line says, it is simulated, and a model that has it explains the data."""
    names = [effect["name"] for effect in found["effects"]]
    assert names[names.index("underlap") + 1] == "bypass"
    assert found["moved"] > 0.02
    assert found["errors"]["bypassed"] < 0.01


def test_a_stage(found):
    """What it brings is in the model that has it, in its turn of the search, and acts."""
    assert found["parameters"] == ["Z0", "tau", "Cl", "c0", "m0", "Ka", "Ts", "bypass.share"]
    assert found["scales"][-2:] == ["Ts", "bypass__share"]
    assert found["errors"]["plain"] < 0.01 < found["errors"]["short"]


def test_a_preset(found):
    """It is listed by its name, with its equations, and simulated."""
    (listed,) = (model for model in found["models"] if model["name"] == "lagging")
    assert any("Ts" in equation["text"] for equation in listed["equations"])


def test_a_figure(found):
    """It is drawn by its name, with a bar a run, by its option; the page has a field for that."""
    assert found["figure"]["mark"]["type"] == "bar"
    assert found["figure"]["encoding"]["x"]["sort"] == "y"
    assert found["fields"] == {"Order": ["as recorded", "by error"]}
    (rows,) = found["figure"]["datasets"].values()
    assert len(rows) == 27


def test_a_reader(found):
    """A file of its ending is read as the same samples."""
    assert found["same"]


def test_an_endpoint(found):
    assert found["greeting"] == {"greeting": "hello"}
