"""Unusable input: one line on standard error, exit status 2, never a traceback."""

from __future__ import annotations

import os
import signal
import time

import pytest

from tests.nursery import WAIT
from tests.running import Forked

ONE_LINE = [
    (["fit"], "missing argument 'MATRIX'; type servoident fit MATRIX"),
    (["compare", "MATRIX"], "type servoident compare MATRIX --fit FIT.json"),
    (["fot"], "there is no command 'fot'; did you mean fit?"),
    (["fit", "nowhere"], "nowhere"),
    (["fit", "nowhere", "--seed", "x"], "type --seed "),
    (["fit", "nowhere", "--colour", "red"], "there is no option --colour; `servoident fit --help`"),
    (["fit", "nowhere", "--efect", "lead"], "there is no option --efect; did you mean --effect?"),
    (["fit", "nowhere", "--effect"], "type --effect VALUE"),
    (["fit", "MATRIX", "--bounds", "Z0"], "NAME=LO:HI"),
    (["fit", "MATRIX", "--bounds", "Z0=1e-6"], "NAME=LO:HI"),
    (["fit", "MATRIX", "--option", "keep=half"], "half"),
    (["fit", "MATRIX", "--option", "generations=nan"], "nan"),
    (["fit", "MATRIX", "--seed", "-1"], "--seed"),
    (["fit", "MATRIX", "--json", "/nowhere/fit.json"], "/nowhere"),
    (["compare", "MATRIX", "--fit", "nowhere.json"], "nowhere.json"),
    (["compare", "MATRIX", "--fit", __file__], "not the JSON of a fit"),
    (["report", "MATRIX", "--out", "report.docx"], ".html"),
    (["report", "MATRIX", "--out", "r.html", "--diagnosis", __file__], "not the JSON of a diagnosis"),
    (["diagnose", "MATRIX", "--fit", "nowhere.json"], "nowhere.json"),
    (["diagnose", "MATRIX", "--fit", "nowhere.json", "--model", "first_order"], "not both"),
    (["diagnose", "MATRIX", "--max-effects", "99"], "99 effects"),
    (["simulate", "MATRIX"], "not empty"),
    (["simulate", "new", "--effect", "magic"], "magic"),
    (["simulate", "new", "--preset", "unknown"], "unknown"),
    (["check", __file__], "test_refusals"),
    (["regress", "--data", "nowhere"], "nowhere"),
    (["regress", "--tolerance", "nan"], "--tolerance"),
    (["regress", "--database", "nonsense"], "postgresql://"),
    (["migrate", "--database", "postgresql://user:secret@127.0.0.1:9/x"], "user:***@127.0.0.1:9"),
    (["worker", "--executor", "w1"], "PostgreSQL"),
    (["serve", "--host", "203.0.113.7"], "203.0.113.7"),
    (["query", "--server", "http://127.0.0.1:9"], "no answer"),
    (["query", "--token", "ü"], "--token"),
    (["approve", "\udcff", "--server", "http://127.0.0.1:9"], "no answer"),
    (["upload", "MATRIX", "--server", "http://127.0.0.1:9"], "no answer"),
    (["upload", __file__], "test_refusals"),
]


@pytest.mark.parametrize(("arguments", "named"), ONE_LINE, ids=[" ".join(a).split("/")[0] for a, _ in ONE_LINE])
def test_unusable_input_is_one_line_and_exit_2(servoident, matrix, arguments, named):
    """The line names what is wrong, and nothing else is said."""
    done = servoident(*(matrix if argument == "MATRIX" else argument for argument in arguments))
    said = [line for line in done.stderr.splitlines() if line.startswith("servoident: ")]
    assert done.returncode == 2, done.stderr
    assert len(said) == 1
    assert done.stderr.splitlines()[-1] == said[0]
    assert named in said[0]
    assert "Traceback" not in done.stderr


def test_ctrl_c_is_one_line_and_130(few, tmp_path):
    """An interrupted fit says so and writes nothing."""
    errors, fit = tmp_path / "errors", tmp_path / "fit.json"
    asked = ("fit", few, "--json", fit, "--method", "differential-evolution")
    process = Forked(asked, os.environ, errors)

    def heard() -> list[str]:
        return [line for line in errors.read_text(encoding="utf-8").splitlines() if "compiling" not in line]

    deadline = time.monotonic() + WAIT
    while not heard() and time.monotonic() < deadline:  # behind the first line of progress the work is under way
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    assert process.wait() == 130, heard()
    assert heard()[-1] == "servoident: interrupted; nothing was written"
    assert "Traceback" not in errors.read_text(encoding="utf-8")
    assert not fit.exists()
    process.kill()


def test_a_defect_is_one_line_that_says_where_the_details_are(monkeypatch, capsys, tmp_path):
    """What nobody foresaw ends with 70; its traceback is in the log, not on the screen."""
    from app.cli import program

    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    monkeypatch.setattr("ident.readers.read_matrix", lambda _: 1 / 0)
    with pytest.raises(SystemExit) as ended:
        program.main(["check", "anything"])
    said = capsys.readouterr().err
    assert ended.value.code == 70
    assert said.count("\n") == 1
    assert "ZeroDivisionError" in said
    assert "Traceback" in (tmp_path / "servoident" / "errors.log").read_text()
