"""What was measured is drawn before any fit, and no sample of it is lost."""

from __future__ import annotations

import numpy as np
import pytest

from ident.errors import Unusable
from ident.figures import Recorded, figure
from ident.matrix import Actuator
from ident.run import Run

RATE, N = 1000.0, 8192
TIME = np.arange(N) / RATE


def recorded(**more: object) -> Run:
    """A chirp, and an output with one spike of one sample and a tone of its own at 200 Hz."""
    command = np.sin(2 * np.pi * 5 * TIME * TIME)
    output = 0.5 * command + 0.02 * np.sin(2 * np.pi * 200 * TIME)
    output[3001] = 9.0
    channels = {"command": command, "displacement": output}
    return Run("one", "-", RATE, channels, {"command": "V", "displacement": "1"}, **more)  # type: ignore[arg-type]


SUBJECT = Recorded([recorded()], Actuator("SW-1"))


@pytest.mark.parametrize(("start", "seconds"), [(None, None), (2.0, 4.0), (2.99, 0.05)])
def test_a_spike_of_one_sample_is_drawn_at_every_zoom(start, seconds):
    spec = figure("signals", SUBJECT, start=start, seconds=seconds).to_dict()
    rows = spec["datasets"]["channel1"]
    assert {"t": 3.001, "y": 9.0} in rows
    assert len(rows) <= 702


def test_a_quiet_stretch_has_the_unit_of_the_whole_record():
    """So that points of one stretch can be drawn over those of another."""
    loud = Run("one", "-", RATE, {"command": TIME**4}, {"command": "m"}, output="command")
    shown = [
        figure("signals", Recorded([loud], Actuator("SW-1")), start=start, seconds=0.1).to_dict(live=True)["params"]
        for start in (None, 0.0, 6.0)
    ]
    (unit,) = {param["value"][1] for params in shown for param in params if param["name"] == "across0"}
    assert unit == "(m)"


def test_the_rows_of_eight_channels_fit_into_a_step_of_the_wheel():
    """200 kB, so that a link of 10 Mbit/s brings them in a sixth of a second."""
    noise = np.random.default_rng(0).standard_normal((8, N))
    run = Run("one", "-", RATE, dict(zip("abcdefgh", noise, strict=True)), {}, output="a")
    assert len(figure("signals", Recorded([run], Actuator("SW-1"))).to_json(live=True)) < 200_000


def test_runs_are_overlaid_a_colour_each_and_a_shorter_one_ends():
    short = Run("two", "-", RATE, {"command": np.ones(100)}, {"command": "V"}, output="command")
    spec = figure("signals", Recorded([recorded(), short], Actuator("S")), run=["one", "two"]).to_dict()
    ends = {row["r"]: row["t"] for row in spec["datasets"]["channel0"]}
    assert ends == {"one": 8.191, "two": 0.099}


def test_a_tone_that_the_command_does_not_make_stands_in_the_spectrum_without_coherence():
    rows = figure("spectra", SUBJECT).to_dict()["datasets"]["spectra"]
    tone = max((row for row in rows if row["f"] > 150), key=lambda row: row["y"])
    assert tone["f"] == pytest.approx(200, abs=1)
    assert tone["c"] < 0.3
    assert np.median([row["c"] for row in rows if 10 < row["f"] < 60]) > 0.9


@pytest.mark.parametrize(
    ("name", "options", "code"),
    [
        ("signals", {"run": "none"}, "unknown-run"),
        ("signals", {"run": ["one"] * 9}, "too-many-runs"),
        ("signals", {"start": 9.0}, "outside-record"),
        ("signals", {"seconds": 0.0}, "outside-record"),
    ],
)
def test_what_is_not_there_is_refused(name, options, code):
    with pytest.raises(Unusable) as refused:
        figure(name, SUBJECT, **options)
    assert refused.value.code == code


def test_a_record_without_an_input_has_no_spectrum_of_a_response():
    run = Run("one", "-", RATE, {"force": np.ones(100)}, output="force")
    with pytest.raises(Unusable, match="no input was recorded"):
        figure("spectra", Recorded([run], Actuator("S")))
