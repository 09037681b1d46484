"""The set-up of the two README commands; a whole set-up is what running the tests on a clean clone shows."""

from __future__ import annotations

import subprocess
import sys

import pytest

from app import environment


@pytest.fixture
def place(tmp_path, monkeypatch):
    """An empty checkout with a lock file of two packages, whose steps only leave their commands."""
    hashes = "    --hash=sha256:" + "0" * 64 + "\n"
    (tmp_path / "some.lock").write_text(f"first==1 \\\n{hashes}uv==0.5 \\\n{hashes}{hashes}zlast==2 \\\n{hashes}")
    (tmp_path / "pyproject.toml").write_text("")
    venv = tmp_path / ".venv"
    for name, value in {"ROOT": tmp_path, "VENV": venv, "PYTHON": venv / "bin/python", "LOG": venv / "log"}.items():
        monkeypatch.setattr(environment, name, value)
    steps: list[list[str]] = []

    def call(command: list[str]) -> None:
        steps.append(command)

    def create() -> None:
        steps.append(["create"])
        environment.PYTHON.parent.mkdir(parents=True)
        environment.PYTHON.touch()

    monkeypatch.setattr(environment, "call", call)
    monkeypatch.setattr(environment, "create", create)
    monkeypatch.setattr(environment, "has_pip", environment.PYTHON.exists)
    return steps


def test_the_second_start_does_nothing(place):
    """The stamp tells that all is there."""
    environment.prepare("some.lock")
    assert place.pop(0) == ["create"]
    assert all("install" in step for step in place)
    place.clear()
    environment.prepare("some.lock")
    assert place == []


def test_the_first_start_compiles_the_projects_modules_meanwhile(place):
    """Those of its own folders alone."""
    for folder in ("ident", "elsewhere"):
        (environment.ROOT / folder).mkdir()
        (environment.ROOT / folder / "chapter.py").write_text("NAME = 1\n")
    environment.prepare("some.lock")
    assert place
    assert environment._compiling.pop().wait(timeout=60) == 0
    assert [path.parent.parent.name for path in environment.ROOT.rglob("*.pyc")] == ["ident"]
    assert not environment._compiling


@pytest.mark.parametrize("changed", ["some.lock", "pyproject.toml"])
def test_a_changed_file_renews_the_environment(place, changed):
    """A new lock or project file installs again, into the same environment."""
    environment.prepare("some.lock")
    place.clear()
    with (environment.ROOT / changed).open("a") as file:
        file.write("# changed\n")
    environment.prepare("some.lock")
    assert place
    assert ["create"] not in place


def test_packages_are_installed_with_hashes_and_the_project_without_dependencies(place):
    """Nothing that is not in the lock file can come in."""
    environment.prepare("some.lock")
    installs = [step for step in place if "install" in step]
    assert all("--require-hashes" in step or "--no-deps" in step for step in installs)
    assert "--no-build-isolation" in installs[-1]


def test_pip_takes_over_where_uv_cannot(place, monkeypatch, capsys):
    """A failing uv is no failure of the set-up."""

    def call(command: list[str]) -> None:
        if "uv" in command:
            raise environment.SetupFailed("no network")
        place.append(command)

    monkeypatch.setattr(environment, "call", call)
    environment.prepare("some.lock")
    assert place[-1][1:4] == ["-m", "pip", "install"]
    assert "with pip, because uv cannot" in capsys.readouterr().err


@pytest.mark.usefixtures("place")
def test_a_failed_set_up_is_tried_again(monkeypatch):
    """Without its stamp an environment counts as unfinished."""

    def call(_: list[str]) -> None:
        raise environment.SetupFailed("no network")

    monkeypatch.setattr(environment, "call", call)
    for _ in range(2):
        with pytest.raises(environment.SetupFailed):
            environment.prepare("some.lock")


@pytest.mark.usefixtures("place")
def test_one_package_of_a_lock_file():
    """Its version with every hash below, and nothing of its neighbours."""
    lines = environment.entry("uv", environment.ROOT / "some.lock").splitlines()
    assert [line.split()[0].partition(":")[0] for line in lines] == ["uv==0.5", "--hash=sha256", "--hash=sha256"]


def test_the_reason_of_a_failing_step_is_told(tmp_path, monkeypatch):
    """The line that starts with ERROR, and where the rest is."""
    monkeypatch.setattr(environment, "LOG", tmp_path / "log")
    script = "import sys; print('ERROR: no such package\\n[notice] a newer pip exists'); sys.exit(1)"
    with pytest.raises(environment.SetupFailed, match=r"ERROR: no such package \(all of it in .*log\)"):
        environment.call([sys.executable, "-c", script])
    assert "newer pip" in (tmp_path / "log").read_text()


def test_an_old_python_is_told_in_one_line():
    """The two files that run first say what they need; they start in any Python 3."""
    script = "import sys; sys.version_info = (3, 8); from app.environment import enter; enter('x', [])"
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=environment.ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 1
    assert done.stderr.count("\n") == 1
    assert "3.11 or later is needed" in done.stderr
