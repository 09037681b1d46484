"""Machines to export, a command to drive them, and what the kernel answers to it."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from ident.effects import EFFECTS
from ident.export import ExportedMachine, as_header, exported
from ident.fit.result import FitResult
from ident.presets import preset
from ident.run import Run, Specimen
from ident.simulation.simulate import responses

FIT = Path(__file__).resolve().parents[1] / "stored" / "fit.json"
RATE = 4096.0
SPECIMEN = Specimen(0.87, 36.3e3, 20.0)
PROGRAM = """
#include <stdio.h>
#include "machine.h"
int main(void)
{
    double u, y[SERVOIDENT_OUTPUTS];
    int i;
    servoident_machine m;
    servoident_reset(&m);
    while (scanf("%lf", &u) == 1) {
        servoident_step(&m, u, y);
        for (i = 0; i < SERVOIDENT_OUTPUTS; i++)
            printf("%.17e ", y[i]);
    }
    return 0;
}
"""


def unit_of_control(source: str, folder: Path) -> tuple[int, set[str]]:
    """The bytes of code, tables and memory of a compiled source, and the names that it calls of libraries."""
    (folder / "unit.c").write_text(source)
    subprocess.run([compiler(), "-Os", "-std=c99", "-c", "unit.c"], cwd=folder, check=True)
    tools = [shutil.which("size"), shutil.which("nm")]
    if not all(tools):
        pytest.skip("no binutils on this machine")
    told, called = (
        subprocess.run([tool, *option, "unit.o"], cwd=folder, check=True, capture_output=True, text=True).stdout
        for tool, option in zip(tools, ((), ("-u",)), strict=True)
    )
    return int(told.splitlines()[1].split()[3]), {line.split()[-1] for line in called.splitlines()}


def fitted() -> FitResult:
    """The fit of Qian's actuator with a dead zone that an earlier version wrote."""
    return FitResult.from_json(json.loads(FIT.read_text()))


def with_effects(*names: str) -> ExportedMachine:
    """Table 4's machine with these effects at a fifth of their largest strength, or with none."""
    bare = exported(fitted(), SPECIMEN, 7.0, RATE)
    model = preset("qian2014", names)
    values = {p.in_equations: p.value or 0.0 for effect in model.effects for p in effect.added}
    values |= {effect.added[0].in_equations: effect.added[0].upper / 5 for effect in model.effects}
    steps = max([effect.steps for effect in EFFECTS if effect.name in names], default=1)
    return ExportedMachine(model, {n: {**bare.values, **values}[n] for n in model.chain.symbols}, RATE, 2 * steps)


def command(samples: int = 4000) -> np.ndarray:
    """A held command of some millimetres that begins with a jump from rest and wanders."""
    rng = np.random.default_rng(4)
    walk = np.cumsum(rng.standard_normal(samples)) * 1e-4
    return np.concatenate([[0.0, 2e-3], 2e-3 + walk - walk.mean()])[:samples]


def simulated(machine: ExportedMachine, channel: str, u: np.ndarray) -> np.ndarray:
    """What the kernel makes of a held command."""
    run = Run("run", "", machine.sample_rate, {"command": u, channel: u}, output=channel, hold="zoh")
    values = {name: np.array([[value]]) for name, value in machine.values.items()}
    return responses(machine.chain, [run], values, machine.steps)[:, 0, 0]


def compiler() -> str:
    """The C compiler, or the test is skipped."""
    found = shutil.which("gcc") or shutil.which("cc") or shutil.which("clang")
    if found is None:
        pytest.skip("no C compiler here: nothing can be compiled")
    return found


def compiled(machine: ExportedMachine, u: np.ndarray, folder: Path) -> np.ndarray:
    """What the header makes of it, compiled without a warning: (samples, channels)."""
    (folder / "machine.h").write_text(as_header(machine))
    (folder / "main.c").write_text(PROGRAM)
    strict = ("-std=c99", "-Wall", "-Wextra", "-Werror", "-O1")
    subprocess.run([compiler(), *strict, "main.c", "-o", "machine", "-lm"], cwd=folder, check=True)
    said = "\n".join(map(repr, u.tolist()))
    done = subprocess.run([folder / "machine"], input=said, capture_output=True, text=True, check=True)
    return np.array(done.stdout.split(), float).reshape(len(u), -1)


def largest_error(found: np.ndarray, wanted: np.ndarray) -> float:
    """The largest difference in standard deviations of what is wanted."""
    return float(np.abs(found - wanted).max() / np.std(wanted))
