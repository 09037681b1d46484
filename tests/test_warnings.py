"""No warning reaches a user's terminal or log: what Python would show there is an error in every test."""

from __future__ import annotations

import os
import subprocess
import sys
import warnings

import numpy as np
import pytest
import yaml
from scipy.signal import lfilter

NUMBERS = "import numpy; numpy.zeros(1) / numpy.zeros(1); print('went on')"
COMMANDS = """
import sys
from app.cli.program import main
for command in (["check"], ["fit", "--model", "first_order"]):
    try:
        main([command[0], sys.argv[1], *command[1:]])
    except SystemExit as ended:
        assert ended.code == 0, ended.code
"""


@pytest.mark.parametrize("number", [lambda: np.ones(1) / np.zeros(1), lambda: np.mean([]), lambda: np.exp([1e9])])
def test_a_number_that_is_none_is_an_error_in_a_test(number) -> None:
    """Raised in our code, as a division, or in that of NumPy for ours, as the mean of nothing."""
    with pytest.raises(RuntimeWarning):
        number()


def test_whatever_is_shown_to_a_user_is_an_error_in_a_test() -> None:
    with pytest.raises(UserWarning):
        warnings.warn("said by a library", UserWarning, stacklevel=1)
    code = compile("import warnings; warnings.warn('old', DeprecationWarning)", "chain.py", "exec")
    with pytest.raises(DeprecationWarning):
        exec(code, {"__name__": "ident.chain.chain"})


def test_a_number_that_is_none_ends_a_process_that_a_test_starts() -> None:
    done = subprocess.run([sys.executable, "-c", NUMBERS], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "RuntimeWarning" in done.stderr
    assert "went on" not in done.stdout


def test_check_and_fit_print_no_warning_where_python_shows_them(tmp_path) -> None:
    """In a process with Python's own filters: a sine, a rest and a staircase, read by a clock that strays."""
    rng, count = np.random.default_rng(1), 600
    sine, rest, stairs = 1e-3 * np.sin(np.arange(count) / 9.0), np.full(count, 1e-3), np.arange(count) // 100 / 1e3
    runs = []
    for name, u in (("sine", sine), ("rest", rest), ("stairs", stairs)):
        x = lfilter([0.0, 0.1], [1.0, -0.9], u) + 1e-6 * rng.standard_normal(count)
        time = (np.arange(count) + 0.2 * rng.uniform(size=count)) / 100
        np.savetxt(tmp_path / f"{name}.csv", np.column_stack([time, u, x]), delimiter=",", header="t,u,x", comments="")
        channels = {"command": {"column": "u", "unit": "m"}, "displacement": {"column": "x", "unit": "m"}}
        runs.append({"id": name, "file": f"{name}.csv", "time": {"column": "t", "unit": "s"}, "channels": channels})
    (tmp_path / "matrix.yaml").write_text(yaml.safe_dump({"actuator": {"serial": "X"}, "runs": runs}))
    told = {name: value for name, value in os.environ.items() if name != "PYTHONWARNINGS"}
    done = subprocess.run(
        [sys.executable, "-c", COMMANDS, tmp_path], env=told, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert "tau" in done.stdout
    assert "Warning" not in done.stderr + done.stdout
