"""The identification of a bench as C for a control unit: compiled, it gives the numbers of the sheet."""

from __future__ import annotations

import subprocess
from dataclasses import replace

import numpy as np
import pytest

from ident.bench.acceptance import found_quantities
from ident.bench.analysis import Analysis, Missing, analyse
from ident.bench.model import DELAY
from ident.bench.records import BenchSet
from ident.errors import Unusable
from ident.export.c_lines import comment
from ident.export.identification import QUANTITIES, as_identification, values_of
from tests.bench.sets import as_set
from tests.export.machines import compiler, unit_of_control
from tests.reference import kononykhin_reference as reference

SEED = 574
MAIN = r"""
#include <stdio.h>
#include "identification.h"
static double samples[3 * $ALL];
static const long first[] = {$FIRST};
static const double begin[] = {$BEGIN};
static void from_memory(void *context, int record, long k, double out[3])
{
    (void)context;
    memcpy(out, samples + 3 * (first[record] + k), 3 * sizeof out[0]);
}
static servoident_identification id;
int main(void)
{
    FILE *file = fopen("samples", "rb");
    int i, ok;
    if (!file || fread(samples, sizeof samples[0], 3 * $ALL, file) != 3 * $ALL) return 2;
    memcpy(id.values, begin, sizeof begin);
    id.begun = 1;
    ok = servoident_identify(&id, from_memory, 0);
    for (i = 0; i < SERVOIDENT_QUANTITIES; i++) printf("%.17g\n", id.sheet[i]);
    fprintf(stderr, "%d steps, error %.17g, %lu bytes\n", id.steps, id.error, (unsigned long)sizeof id);
    return !ok;
}
"""


@pytest.fixture(scope="module")
def bench(full: bool) -> BenchSet:
    truth = reference.scattered(SEED)
    return as_set(truth, reference.full_set(truth, SEED, short=not full))


@pytest.fixture(scope="module")
def analysis(bench: BenchSet) -> Analysis:
    return analyse(bench)


def identified(header: str, bench: BenchSet, begin: np.ndarray, folder) -> tuple[np.ndarray, str]:
    """The sheet's numbers that the compiled header finds in the records of a set."""
    records = bench.records
    nothing = [np.zeros(one.length) if one.pressure is None else one.pressure for one in records]
    rows = [np.column_stack([one.current, one.position, p]) for one, p in zip(records, nothing, strict=True)]
    np.concatenate(rows).astype("<f8").tofile(folder / "samples")
    ends = np.cumsum([0, *(one.length for one in records)])
    main = MAIN.replace("$ALL", str(ends[-1])).replace("$FIRST", ", ".join(map(str, ends[:-1])))
    (folder / "main.c").write_text(main.replace("$BEGIN", ", ".join(map(repr, map(float, begin)))))
    (folder / "identification.h").write_text(header)
    strict = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic"]
    subprocess.run([compiler(), "-O2", *strict, "main.c", "-o", "main", "-lm"], cwd=folder, check=True)
    done = subprocess.run([folder / "main"], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return np.array(list(map(float, done.stdout.split()))), done.stderr


def off_the_sheet(bench: BenchSet, analysis: Analysis, folder) -> dict[str, float]:
    """How far each quantity of the compiled identification ends from the sheet, begun 10 % off; relative."""
    values = np.array(values_of(analysis.model))
    begin = values * (1 + 0.1 * np.random.default_rng(SEED).uniform(-1, 1, len(values)))
    found, said = identified(as_identification(analysis), bench, begin, folder)
    print(said)
    sheet = found_quantities(analysis)
    return {name: float(found[i] / sheet[name].value - 1) for i, name in enumerate(QUANTITIES)}


def test_the_identification_of_a_control_unit_gives_the_numbers_of_the_sheet(bench, analysis, tmp_path):
    """From values that are off by 10 % to 1e-6 of each quantity of the sheet."""
    off = off_the_sheet(bench, analysis, tmp_path)
    print(off)
    assert max(map(abs, off.values())) <= 1e-6


def test_the_code_is_small_and_takes_no_memory_from_a_heap(analysis, tmp_path):
    """Code, tables and memory together below 64 kB; nothing but the standard and the mathematical library is called."""
    (tmp_path / "identification.h").write_text(as_identification(analysis))
    call = "int find(servoident_read read, void *context) { return servoident_identify(&id, read, context); }\n"
    source = f'#include "identification.h"\nstatic servoident_identification id;\n{call}'
    size, called = unit_of_control(source, tmp_path)
    print(size, called)
    assert size < 64 * 1024
    known = {"sqrt", "exp", "log", "pow", "hypot", "floor", "memset", "memcpy", "memmove", "__stack_chk_fail"}
    assert called <= known


def test_another_actuator_is_found_by_the_header_of_the_first(analysis, tmp_path, full):
    """Under the same program: every quantity within half a standard error of its own analysis."""
    if not full:
        pytest.skip("another analysis: run with --full")
    truth = reference.scattered(SEED)
    other = truth._replace(T=1.2 * truth.T, B=1.3 * truth.B, kp=0.9 * truth.kp, dPfr=1.1 * truth.dPfr)
    bench = as_set(other, reference.full_set(other, SEED + 1))
    begin = np.array(list(map(float, values_of(analysis.model))))
    found, _ = identified(as_identification(analysis), bench, begin, tmp_path)
    own = found_quantities(analyse(bench))
    off = {name: (found[i] - own[name].value) / own[name].deviation for i, name in enumerate(QUANTITIES)}
    print({name: round(float(z), 2) for name, z in off.items()})
    assert max(map(abs, off.values())) <= 0.5


def test_a_set_that_is_not_whole_and_a_model_with_effects_are_refused(analysis):
    missing = replace(analysis, missing=(Missing("the time constant T", "frequency"),))
    for what, code in ((missing, "missing-record"), (with_delay(analysis), "no-export")):
        with pytest.raises(Unusable) as refused:
            as_identification(what)
        assert refused.value.code == code


def with_delay(analysis: Analysis) -> Analysis:
    """The same whose model has a delay."""
    whole = analysis.whole
    model = replace(whole.model, strengths={DELAY: 1e-3})
    return replace(analysis, whole=replace(whole, residual=replace(whole.residual, model=model)))


def test_no_name_of_a_record_leaves_the_comment_of_a_header():
    """Nor does it begin another, or reach the next line."""
    assert comment('a */ b /* c \\\né "d"') == 'a * / b / * c /-- "d"'
