"""The matrix page puts what matters first."""

from __future__ import annotations

from app.pages.matrix_view import matrix_view
from schemas.matrix import FindingView, MatrixView, RunView


def stored(*findings: tuple[str | None, str]) -> MatrixView:
    runs = [
        RunView(
            id=name, use=use, kind="blwn", hold="linear", output="displacement", samples=8192, sample_rate=4096.0,
            duration=2.0, gain=None, amplitude=None, mass=None, stiffness=None, damping=None,
            channels=["command", "displacement"],
        )
        for name, use in (("a", "fit"), ("b", "verify"))
    ]  # fmt: skip
    views = [FindingView(run=run, severity=severity, code="c", text="words") for run, severity in findings]
    return MatrixView(
        id="m", serial="S", parent=None, created_at="", data_hash="0", runs=runs, findings=views, notices=[]
    )


def test_faults_come_before_doubts_and_notes_stand_apart():
    page = matrix_view(stored(("a", "note"), ("a", "doubt"), ("b", "fault"), (None, "doubt")))
    assert [run for run, _ in page.flagged] == ["b", "a"]
    assert [entry.severity for entry in page.general] == ["doubt"]
    assert len(page.remarks) == 1
    assert page.runs[0].worst == "doubt"
    assert page.runs[1].findings == "1 fault"


def test_what_a_run_does_not_state_is_a_dash():
    run = matrix_view(stored()).runs[0].run
    assert (run.gain, run.amplitude, run.specimen) == ("–", "–", "–")
    assert matrix_view(stored()).summary == "2 runs: 1 to fit, 1 to verify; 4.00 s in all; no findings"
