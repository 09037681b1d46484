"""The matrix page puts what matters first."""

from __future__ import annotations

from app.pages.matrix_view import matrix_view
from schemas.matrix import FindingView, MatrixView, RunView


def stored(*findings: tuple[str | None, str]) -> MatrixView:
    runs = [
        RunView(
            id=name,
            use=use,
            kind="blwn",
            hold="linear",
            output="displacement",
            samples=8192,
            sample_rate=4096.0,
            duration=2.0,
            gain=None,
            amplitude=None,
            mass=None,
            stiffness=None,
            damping=None,
            channels=["command", "displacement"],
        )
        for name, use in (("a", "fit"), ("b", "verify"))
    ]
    views = [FindingView(run=run, severity=severity, code="c", text="words") for run, severity in findings]
    return MatrixView(
        id="m", serial="S", parent=None, created_at="", data_hash="0", runs=runs, findings=views, notices=[]
    )


def test_faults_come_before_doubts_and_notes_stand_apart():
    page = matrix_view(stored(("a", "note"), ("a", "doubt"), ("b", "fault"), (None, "doubt"), (None, "note")))
    assert [(flag.place, flag.run, flag.severity) for flag in page.flags] == [(1, "b", "fault"), (0, "a", "doubt")]
    assert [entry.severity for entry in page.general] == ["doubt"]
    assert len(page.remarks) == 1
    assert page.runs[0].worst == "doubt"
    assert [entry.severity for entry in page.runs[0].findings] == ["doubt", "note"]


def test_a_doubt_that_many_runs_share_is_said_once():
    page = matrix_view(stored(("a", "doubt"), ("b", "doubt")))
    (flag,) = page.flags
    assert (flag.run, flag.others) == ("a", 1)


def test_beside_its_run_a_finding_does_not_name_it_again():
    view = stored(("a", "doubt"))
    view.findings[0].text = "force of run a is clipped"
    assert matrix_view(view).runs[0].findings[0].text == "force is clipped"


def test_what_a_run_does_not_state_is_a_dash():
    run = matrix_view(stored()).runs[0].run
    assert (run.gain, run.amplitude, run.specimen) == ("–", "–", "–")
    assert matrix_view(stored()).summary == "2 runs: 1 for estimation, 1 for validation; 4.00 s in all; no findings"
