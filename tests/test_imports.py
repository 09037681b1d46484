"""Who may import whom: the house rules, read from the source."""

from __future__ import annotations

import ast
import importlib
import importlib.util
import re
import sys
from collections.abc import Collection, Iterator, Mapping
from dataclasses import is_dataclass
from functools import cache
from pathlib import Path

import pytest

from app.openapi import RESULTS
from ident.presets import PRESETS

ROOT = Path(__file__).resolve().parents[1]
OWN = {"ident", "app", "schemas", "migrations", "tests", "benchmarks"}
STANDARD = set(sys.stdlib_module_names) | {"__future__"}


@cache
def imports(file: Path) -> set[str]:
    """Every module that a file imports anywhere, in full; also one that it asks for by its name as a text."""
    return imported(file.read_text(encoding="utf-8"), str(file))


def imported(source: str, file: str = "") -> set[str]:
    """The modules that a source text imports."""
    found = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{file}:{node.lineno}: relative import"
            found |= {f"{node.module}.{alias.name}" for alias in node.names}
        elif isinstance(node, ast.Call) and (name := by_text(node)):
            found.add(name)
    return found


def by_text(call: ast.Call) -> str:
    """The module of `import_module("a.b")`; of `import_module(f"a.{b}")` the package a; "" of any other call."""
    called = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
    given = [*call.args[:1], *(one.value for one in call.keywords if one.arg == "name")]
    if called not in ("import_module", "__import__") or not given:
        return ""
    text = given[0].values[0] if isinstance(given[0], ast.JoinedStr) else given[0]
    found = text.value if isinstance(text, ast.Constant) and isinstance(text.value, str) else ""
    return found if text is given[0] else found.rpartition(".")[0]


@pytest.mark.parametrize(
    ("source", "module"),
    [
        ('import_module("ident.readers.mat")', "ident.readers.mat"),
        ('importlib.import_module("ident.readers").read_matrix(path)', "ident.readers"),
        ('getattr(import_module(name="ident.readers.mat"), "read_mat")', "ident.readers.mat"),
        ('import_module(f"ident.readers.{kind}")', "ident.readers"),
        ('import_module(f"ident.readers.read_{kind}")', "ident.readers"),
        ('__import__("ident.readers")', "ident.readers"),
    ],
)
def test_an_import_by_a_text_is_seen(source, module):
    """A file that asks for a module by a text depends on it as one that imports it at its head."""
    assert imported(source) == {module}
    assert not imported('import_module(ROOMS[name])\nread("ident.readers")')


def files(*patterns: str) -> list[Path]:
    """Source files by glob."""
    return sorted(path for pattern in patterns for path in ROOT.glob(pattern))


def offences(sources: list[Path], forbidden: set[str], allowed: set[str] = frozenset()) -> Iterator[str]:
    """Each import of a forbidden module or package, but for the allowed ones below it."""
    for file in sources:
        for module in sorted(imports(file)):
            if within(module, forbidden) and not within(module, allowed):
                yield f"{file.relative_to(ROOT)} imports {module}"


def within(module: str, packages: set[str]) -> bool:
    """True where `module` is one of the packages or below one."""
    return any(module == package or module.startswith(f"{package}.") for package in packages)


WEB = {"fastapi", "starlette", "uvicorn", "pydantic", "sqlalchemy", "alembic", "dbos", "jinja2", "typer", "httpx"}


def test_the_library_knows_no_web_no_database_and_no_service():
    """`ident` can be used alone from a notebook."""
    assert not list(offences(files("ident/**/*.py"), WEB | OWN - {"ident"}))


def test_only_figures_draw():
    """Altair is imported below ident/figures and nowhere else."""
    others = [file for file in files("ident/**/*.py", "app/**/*.py", "schemas/**/*.py") if "figures" not in file.parts]
    assert not list(offences(others, {"altair"}))


@pytest.mark.parametrize("file", files("benchmarks/*.py", "docs/**/*.py"), ids=lambda file: file.stem)
def test_what_a_benchmark_or_a_picture_imports_is_there(file):
    """They run seldom: a name that moved is noticed here."""
    for module in sorted(imports(file)):
        parent, _, name = module.rpartition(".")
        if within(module, OWN) and parent:
            found = hasattr(importlib.import_module(parent), name)
            assert found or importlib.util.find_spec(module) is not None, module


ROOMS = (
    "errors",
    "plain",
    "cached",
    "progress",
    "time_budget",
    "parallel",
    "unstable",
    "rounding",
    "words",
    "resolution",
    "beginning",
    "linear_filter",
    "slopes",
    "run",
    "rig",
    "matrix",
    "parameter",
    "linear",
    "statistics",
    "equations",
    "units",
    "stages",
    "effects",
    "chain",
    "presets",
    "foreign",
    "readers",
    "custom",
    "noise",
    "preprocessing",
    "stability",
    "checks",
    "drafts",
    "simulation",
    "fit",
    "comparison",
    "residuals",
    "design",
    "diagnosis",
    "bench",
    "hybrid",
    "export",
    "decimation",
    "figures",
    "synthesis",
    "planning",
    "workflows",
)
"""The files and folders of `ident`; each may use those before it."""


ROOMS_OF_THE_SERVICE = (
    "environment", "settings", "request_id", "nearest_field", "lru", "processes", "storage", "database", "tables",
    "client", "blobs", "context", "errors", "form", "paging", "security", "reserve", "idempotency",
    "access", "display", "openapi",
    "catalogue", "parameters", "webhooks", "matrices", "drafts", "live", "stream", "backup",
    "jobs", "retention", "workers", "operation", "own_effects", "limits", "statistics",
    "fits", "approvals", "annotations", "diagnoses", "profiles", "refits", "hybrid", "plans", "regress", "deletions",
    "actuators", "search", "verdicts", "report", "figures",
    "kinds", "pages", "main", "cli", "__main__",
)  # fmt: skip
"""The files and folders of `app`; each may use those before it."""


WORDS = {"specimen"}
"""Models called by a word that matrix.yaml has for something else: what a run moves."""


def room(module: str) -> str:
    """The room of a module of the library or of the service."""
    return module.split(".")[1]


@pytest.mark.parametrize(("house", "rooms"), [("ident", ROOMS), ("app", ROOMS_OF_THE_SERVICE)])
def test_the_rooms_stand_in_one_order(house, rooms):
    """Data flow one way: a room uses what stands before it, so no two use each other and none stands in a circle."""
    upwards = {}
    for file in files(f"{house}/**/*.py"):
        own = file.relative_to(ROOT / house).parts[0].removesuffix(".py")
        if own == "__init__":
            continue
        for module in imports(file):
            if within(module, {house}) and "." in module and rooms.index(room(module)) > rooms.index(own):
                upwards.setdefault((own, room(module)), []).append(f"{file.relative_to(ROOT)} imports {module}")
    assert not upwards


def test_no_files_stand_in_a_circle():
    """Also not for the types of their annotations: what a file says can be understood without what is built on it."""
    modules = {
        ".".join(file.relative_to(ROOT).with_suffix("").parts): file
        for file in files("ident/**/*.py", "app/**/*.py", "schemas/**/*.py")
    }
    modules = {name.removesuffix(".__init__"): file for name, file in modules.items()}
    used = {
        name: {found for module in imports(file) if (found := nearest_file(module, modules)) != name}
        for name, file in modules.items()
    }
    assert not circles(used)


def nearest_file(module: str, files: Collection[str]) -> str:
    """The file that an import names, or that defines the name; "" of a foreign one."""
    while module and module not in files:
        module = module.rpartition(".")[0]
    return module


def circles(used: Mapping[str, Collection[str]]) -> set[str]:
    """What is left of a graph once whatever uses nothing of the rest, or is used by nothing of it, is taken away."""
    rest = set(used)
    while True:
        ends = {name for name in rest if rest.isdisjoint(used[name])}
        ends |= rest - {other for name in rest for other in used[name]}
        if not ends:
            return rest
        rest -= ends


def test_a_circle_is_seen():
    assert circles({"a": ["b"], "b": ["c"], "c": ["b"], "d": []}) == {"b", "c"}


def test_nothing_outside_the_presets_knows_a_model_by_its_name():
    """A fact about a model stands with its preset: nothing is compared with its name or tabled by it."""
    names = PRESETS.keys() - WORDS
    quoted = re.compile("|".join(f"[\"']{name}[\"']" for name in names))
    sources = {
        file: file.read_text(encoding="utf-8")
        for file in files("ident/**/*.py", "app/**/*.py", "schemas/**/*.py")
        if ROOT / "ident" / "presets" not in file.parents
    }
    found = [
        f"{file.relative_to(ROOT)}:{line}"
        for file, source in sources.items()
        if quoted.search(source)
        for line in chosen_by_name(ast.parse(source), names)
    ]
    assert not found


@pytest.mark.parametrize(
    "code",
    [
        'if model == "drive": pass',
        'if "drive" != model: pass',
        'if model in ("x", "drive"): pass',
        'NAME = "drive"\nif model == NAME: pass',
        'NAMES = ("drive",)\nif model in NAMES: pass',
        'TABLE = {"drive": 1}',
        'x = table["drive"]',
        'x = table.get("drive")',
        'match model:\n  case "drive": pass',
    ],
)
def test_a_choice_by_the_name_of_a_model_is_seen(code):
    assert list(chosen_by_name(ast.parse(code), {"drive"}))
    assert not list(chosen_by_name(ast.parse('def fit(model: str = "drive"): pass'), {"drive"}))


def chosen_by_name(tree: ast.Module, names: set[str]) -> Iterator[int]:
    """The lines that compare with a name, key a table by it or match it, in words or by a constant that holds it."""
    constants: set[str] = set()

    def held(node: ast.AST | None) -> bool:
        if isinstance(node, ast.Tuple | ast.List | ast.Set):
            return any(map(held, node.elts))
        if isinstance(node, ast.Name):
            return node.id in constants
        return isinstance(node, ast.Constant) and node.value in names

    for node in tree.body:
        if isinstance(node, ast.Assign) and held(node.value):
            constants |= {target.id for target in node.targets if isinstance(target, ast.Name)}
    for node in ast.walk(tree):
        by: list[ast.AST | None] = []
        if isinstance(node, ast.Compare):
            by = [node.left, *node.comparators]
        elif isinstance(node, ast.Dict):
            by = list(node.keys)
        elif isinstance(node, ast.Subscript):
            by = [node.slice]
        elif isinstance(node, ast.MatchValue):
            by = [node.value]
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "get":
            by = list(node.args[:1])
        if any(map(held, by)):
            yield node.lineno


def test_there_is_no_loose_file_but_the_basic_words_and_the_workflows():
    """What belongs together stands in a folder."""
    loose = {file.stem for file in files("ident/*.py")} - {"__init__"}
    assert loose == {
        "errors", "plain", "cached", "progress", "time_budget", "parallel", "unstable", "rounding", "resolution",
        "beginning", "linear_filter", "run",
        "matrix", "parameter", "linear", "workflows",
    }  # fmt: skip


def test_effects_never_import_each_other():
    """An effect is one file; only the list of the catalogue names them all. What effects share stands apart."""
    apart = ("effect", "needs", "ringing", "second_mass")
    own = [file for file in files("ident/effects/*.py") if file.stem not in {"__init__", *apart}]
    assert not list(offences(own, {"ident.effects"}, {f"ident.effects.{name}" for name in apart}))


def test_syntax_trees_are_made_in_one_place():
    """Python 3.11 cannot make two at once: whoever parses beside the others' lock makes all of them fail."""
    asking = [
        file for file in files("ident/**/*.py", "app/**/*.py") if "ast.parse(" in file.read_text(encoding="utf-8")
    ]
    assert asking == [ROOT / "ident" / "equations" / "grammar.py"]


def test_stages_never_import_an_effect():
    """The linear core of a place does not know what may be added to it."""
    assert not list(offences(files("ident/stages/*.py"), {"ident.effects"}))


def test_schemas_import_pydantic_and_results_of_the_library():
    """The contract's models know no service. What a result of the library holds is not said again."""
    for file in files("schemas/**/*.py"):
        others = {m for m in imports(file) if m.split(".")[0] not in STANDARD | {"pydantic", "schemas"}}
        foreign = {module for module in others if not (within(module, {"ident"}) and is_result(module))}
        assert not foreign, f"{file.relative_to(ROOT)} imports {sorted(foreign)}"


def test_the_client_needs_httpx_and_pydantic_only():
    """It can be copied beside `schemas` to a machine that has nothing else of the program."""
    models = {f"schemas.{file.stem}": file for file in files("schemas/*.py")}
    needed, read = [ROOT / "app" / "client.py"], set()
    while needed:
        file = needed.pop()
        read |= imports(file)
        needed += [model for name in imports(file) if (model := models.pop(nearest_file(name, models), None))]
    assert {module.split(".")[0] for module in read} - STANDARD == {"httpx", "pydantic", "schemas"}


FRAME = {
    "app.access.roles",
    "app.access.caller",
    "app.context",
    "app.errors",
    "app.form",
    "app.idempotency",
    "app.jobs.queueing",
}
"""What every endpoint may use beside its service: who may and who asks, the running service, its refusals, answers
given once, a job queued once."""


@pytest.mark.parametrize("file", files("app/**/*endpoints.py"), ids=lambda file: f"{file.parent.name}.{file.stem}")
def test_endpoints_import_only_their_service_and_schemas(file):
    """An endpoint parses, calls and returns; what it does stands in its service. It may return a library's result."""
    feature = ".".join(file.parent.relative_to(ROOT).parts)
    own = {f"{feature}.{path.stem}" for path in file.parent.glob("*.py")} - {f"{feature}.repository"}
    if feature == "app.pages":  # a page shows what several services know
        own |= {".".join(path.relative_to(ROOT).with_suffix("").parts) for path in files("app/*/service.py")}
    results = {module for module in imports(file) if within(module, {"ident"}) and is_result(module)}
    assert not list(offences([file], OWN | {"sqlalchemy", "dbos"}, {"schemas"} | own | FRAME | results))


def is_result(name: str) -> bool:
    """Whether an import is a dataclass that the OpenAPI document knows by its name."""
    module, _, kind = name.rpartition(".")
    return kind in RESULTS and is_dataclass(getattr(importlib.import_module(module), kind))


def test_only_a_repository_builds_a_query():
    """Elsewhere SQLAlchemy is its errors, and the types of what is handed to a repository; tables only declare."""
    allowed = {"sqlalchemy.exc", "sqlalchemy.orm.Session", "sqlalchemy.orm.sessionmaker", "sqlalchemy.Engine"}
    apart = {"repository.py", "database.py"}
    others = [
        file
        for file in files("app/**/*.py")
        if file.name not in apart and file.parent.name not in ("tables", "repository")
    ]
    assert not list(offences(others, {"sqlalchemy"}, allowed))


def test_only_the_jobs_file_knows_the_job_engine():
    """DBOS can be exchanged in one file, app/jobs/engine.py."""
    others = [file for file in files("app/**/*.py", "ident/**/*.py") if file != ROOT / "app" / "jobs" / "engine.py"]
    assert not list(offences(others, {"dbos"}))


def test_a_report_knows_neither_pages_nor_commands():
    """What pages, report and command line all say stands in `ident/words` and in the services."""
    assert not list(offences(files("app/report/*.py"), {"app.pages", "app.cli"}))


def test_the_bootstrap_runs_in_a_bare_python():
    """What the README's two commands run first imports the standard library only, and the packages' heads nothing."""
    bare = [ROOT / name for name in ("app/environment.py", "app/__main__.py", "tests/__main__.py")]
    for file in bare:
        foreign = {m for m in imports(file) if m.split(".")[0] not in STANDARD and not within(m, {"app.environment"})}
        assert not foreign, f"{file.relative_to(ROOT)} imports {sorted(foreign)}"
    assert not imports(ROOT / "app" / "__init__.py") | imports(ROOT / "tests" / "__init__.py")


def test_the_command_line_imports_nothing_heavy_before_a_command_runs():
    """`servoident --help` answers at once, because numpy and the service are imported inside the commands."""
    light = {
        "app.cli",
        "ident.errors",
        "ident.words",
        "ident.progress",
        "ident.fit.settings",
        "ident.fit.result",
    }
    for file in files("app/cli/*.py"):
        tree = ast.parse(file.read_text(encoding="utf-8"))
        for node in tree.body:
            if isinstance(node, ast.ImportFrom) and node.module and node.module.split(".")[0] in OWN:
                assert within(node.module, light), f"{file.name}: import {node.module} inside the command"
            if isinstance(node, ast.Import | ast.ImportFrom) and file.name != "tables.py":
                names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else [str(node.module)]
                assert not [name for name in names if name.split(".")[0] in {"numpy", "rich", "scipy", "httpx"}], file


def test_no_file_is_named_after_nothing():
    """A file is named after its one concept."""
    vague = {"utils", "util", "helpers", "helper", "manager", "common", "misc"}
    assert not [path for path in files("ident/**/*.py", "app/**/*.py", "schemas/**/*.py") if path.stem in vague]
