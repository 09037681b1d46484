"""What laboratories write, read beside numbers that are stated by hand; and damaged, refused or read."""

from __future__ import annotations

import importlib.util
import json
import subprocess
import sys
import time
import tracemalloc

import numpy as np
import pytest

from ident.errors import Unusable
from ident.readers import read_matrix, read_table
from ident.readers.dialect import FOUND
from ident.readers.limits import LIMITS, Limits
from tests.readers.lab_files import APART, BESIDE, DESCRIBED, FILES, ROWS, U, X, controldesk, diadem, lvm, mts, uff
from tests.readers.lab_mdf import mdf3

HAS_MDF = importlib.util.find_spec("asammdf") is not None


@pytest.fixture(scope="session")
def extras(full, tmp_path_factory):
    """A folder with the parsers that are extras, which --full installs there; nothing where they are not wanted."""
    if HAS_MDF or not full:
        return None
    folder = tmp_path_factory.mktemp("extras")
    pip = [sys.executable, "-m", "uv", "pip", "install", "--quiet", "--system-certs", "--python", sys.executable]
    subprocess.run([*pip, "--target", folder, "asammdf>=8"], check=True)
    return folder


@pytest.fixture(params=sorted(FILES))
def form(request, extras, monkeypatch) -> str:
    """Each format in turn, its parser installed."""
    if request.param.startswith("mdf"):
        if not HAS_MDF and extras is None:
            pytest.skip("asammdf is an extra and not installed: --full installs it")
        if extras is not None:
            monkeypatch.setattr(sys, "path", [*sys.path, str(extras)])
    return str(request.param)


def test_every_format_reads_to_the_numbers_that_were_written(form, tmp_path):
    """Time, command and displacement of a run in SI, exactly; the rate from the times."""
    ending, made, (time, u, x) = FILES[form]
    for name, data in {f"run{ending}": made(), **BESIDE.get(form, {})}.items():
        (tmp_path / name).write_bytes(data)
    quoted = DESCRIBED.format(ending=ending, time=time, u=u, x=x)
    (tmp_path / "matrix.yaml").write_text(quoted)
    run = read_matrix(tmp_path).runs[0]
    np.testing.assert_array_equal(run.command, U)
    np.testing.assert_allclose(run.measured, 1e-3 * np.array(X), rtol=1e-15)
    assert run.sample_rate == 4.0


NO_UNITS = {"records", "simulink", "dspace"}


def test_units_that_a_file_states_are_told(form):
    if form in NO_UNITS:
        pytest.skip("it has no units")
    ending, made, (_, u, x) = FILES[form]
    table = read_table(made(), f"run{ending}", FOUND, LIMITS, near=lambda name: beside(name, form))
    assert [table.units[table.number(column, "")] for column in (u, x)] == ["V", "mm"]


def test_a_record_a_line_and_an_object_of_columns_are_json_as_well():
    """And a list of records that stands in an object beside what describes it."""
    lines = "\n".join(json.dumps({"u": u, "x": x}) for u, x in zip(U, X, strict=True))
    columns = json.dumps({"u": U, "x": X})
    held = json.dumps({"bench": "one", "data": [{"u": u, "x": x} for u, x in zip(U, X, strict=True)]})
    for made in (lines, columns, held):
        table = read_table(made.encode(), "run.json", FOUND, LIMITS)
        assert table.names == ("u", "x")
        np.testing.assert_array_equal(table.load([1])[0], X)


def test_a_record_within_a_document_is_the_part_that_has_the_most_numbers():
    """Lists of what the specimen is made of, and of who tested it, stand beside it."""
    ply = {"thickness": [1.1, 11.0], "modulus": [2e11, 3e9]}
    held = {"source": [{"title": "a"}, {"title": "b"}], "ply": ply, "test": {"name": "c", "dt": 0.5, "u": U, "x": X}}
    table = read_table(json.dumps(held).encode(), "run.json", FOUND, LIMITS)
    assert (table.names, table.rate) == (("u", "x"), 2.0)
    np.testing.assert_array_equal(table.load([1])[0], X)


def test_columns_of_the_same_names_in_other_parts_of_a_document_are_offered_and_said():
    """A test as it was measured, and as a model is to follow it, with samples in between: the second has more."""
    between = {"u": list(np.repeat(U, 2)), "x": list(np.repeat(X, 2))}
    held = {"name": "c", "data": {"u": U, "x": X}, "run_data": between, "ply": {"thickness": [1.0, 11.0]}}
    table = read_table(json.dumps(held).encode(), "run.json", FOUND, LIMITS)
    assert table.names == ("u", "x", "data/u", "data/x")
    np.testing.assert_array_equal(table.load([table.number("data/x", "")])[0], X)
    assert table.number("run_data/x", "") == table.number("x", "") == 1
    assert table.notices == (
        "run.json: 'u' is the column of 'run_data', which has the most samples; it stands in data, too, as 'data/u'",
    )


def test_a_list_of_signals_within_a_document_is_read_by_their_names_and_units():
    """Each signal is an object with its name, its unit and its samples; lists of settings stand beside them."""
    signals = [{"name": name, "units": unit, "data": list(one)} for name, unit, one in (("u", "V", U), ("x", "mm", X))]
    held = {"settings": {"table": [0, 1, 2]}, "scenario": {"steps": [{"at": 1}]}, "traces": signals}
    table = read_table(json.dumps(held).encode(), "run.json", FOUND, LIMITS)
    assert (table.names, table.units) == (("u", "x"), ("V", "mm"))
    np.testing.assert_array_equal(table.load([1])[0], X)


@pytest.mark.parametrize(
    ("name", "data", "code"),
    [
        ("run.uff", uff().replace(b"        16", b"        17"), "broken-uff"),
        ("run.uff", b"    -1\n   151\nmodel\n    -1\n", "broken-uff"),
        ("run.lvm", lvm() + lvm(), "many-segments"),
        ("run.lvm", lvm(False).replace(b"Delta_X", b"Delta"), "broken-lvm"),
        ("run.csv", controldesk().replace(b"Stand", b"Sta\rnd"), "broken-controldesk"),
        ("run.csv", controldesk().replace(b"0.125", b"much"), "not-numeric"),
        ("run.dat", mts().replace(b"0.125", b"much"), "not-numeric"),
        ("run.dat", b"MTS793|MPT|\n\nwords\nalone\n", "broken-mts"),
        ("run.dat", diadem(), "missing-file"),
        ("run.dat", b"DIAEXTENDED  {@:ENGLISH}\n#BEGINGLOBALHEADER\n", "broken-diadem"),
        ("run.dat", diadem().replace(b"REAL64", b"TWOC12"), "broken-diadem"),
        ("run.dat", diadem().replace(b"220,16", b"220,17"), "missing-file"),
        ("run.xlsx", b"PK\3\4", "broken-excel"),
        ("run.json", b'[{"u": 1, "x": 2}, {"u": 1}]', "broken-records"),
        ("run.json", b"[" * 100_000, "broken-records"),
        ("run.json", b'[{"u": "1"}]', "not-numeric"),
        ("run.csv.gz", b"\x1f\x8b\x08", "broken-gzip"),
        ("run.npz.gz", b"x", "unknown-type"),
        ("run.csv", b"u,x\nV,mm\nHz,Hz\n1,2\n", "not-numeric"),
    ],
)
def test_what_is_not_a_whole_file_of_its_kind_is_refused(name, data, code):
    with pytest.raises(Unusable) as refused:
        read_table(data, name, FOUND, LIMITS).load([0, -1])
    assert refused.value.code == code
    assert "\n" not in str(refused.value)


@pytest.mark.skipif(HAS_MDF, reason="asammdf is installed")
def test_without_the_extra_an_mdf_file_is_refused_with_what_to_install():
    with pytest.raises(Unusable, match=r"install servoident\[mdf\]") as refused:
        read_table(mdf3(ROWS), "run.mf4", FOUND, LIMITS)
    assert refused.value.code == "not-installed"


def test_a_compressed_text_that_unpacks_to_far_more_is_refused_before_it_is_unpacked():
    import gzip

    bomb = gzip.compress(b"u,x\n" + b"0,0\n" * (8 << 20))
    tracemalloc.start()
    with pytest.raises(Unusable) as refused:
        read_table(bomb, "run.csv.gz", 0, Limits(ratio_from=1 << 20, ratio=20))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert refused.value.code == "zip-bomb"
    assert peak < 16 << 20


PARSERS = {
    "eats": "def columns(path):\n    held = []\n    while True:\n        held.append(bytearray(1 << 28))\n",
    "hangs": "def columns(path):\n    while True:\n        pass\n",
    "crashes": "import os\ndef columns(path):\n    os.abort()\n",
    "waits": "import time\ndef columns(path):\n    time.sleep(1.5)\n    return [('u', 'V', [1.0, 2.0])]\n",
    "prints": "def columns(path):\n    print('I am a parser')\n    return [('u', 'V', [1.0, 2.0])]\n",
}


@pytest.mark.parametrize(("parser", "code"), [("eats", "too-large"), ("hangs", "too-slow"), ("crashes", "broken-eats")])
def test_a_parser_that_goes_astray_ends_as_a_refusal(parser, code, tmp_path, monkeypatch):
    """One that eats memory, one that never ends, one that takes its process down."""
    from ident.readers.sandboxed_parser import read_sandboxed

    _install(tmp_path, monkeypatch, parser)
    limits = Limits(parser_seconds=1.0 if parser == "hangs" else 10.0, parser_memory=1 << 30)
    with pytest.raises(Unusable) as refused:
        read_sandboxed(parser, b"x", "run", limits)
    assert refused.value.code == code.replace("eats", parser)


def test_a_parser_that_waits_for_a_processor_is_not_too_slow_until_its_wait_ends(tmp_path, monkeypatch):
    """A busy machine, on which a second of a processor takes longer by the clock."""
    from ident.readers.sandboxed_parser import read_sandboxed

    _install(tmp_path, monkeypatch, "waits")
    table = read_sandboxed("waits", b"x", "run", Limits(parser_seconds=1.0))
    assert table.load([0])[0].tolist() == [1.0, 2.0]
    with pytest.raises(Unusable) as refused:
        read_sandboxed("waits", b"x", "run", Limits(parser_wait=1.0))
    assert refused.value.code == "too-slow"


def test_what_a_parser_prints_is_not_taken_for_its_answer(tmp_path, monkeypatch):
    from ident.readers.sandboxed_parser import read_sandboxed

    _install(tmp_path, monkeypatch, "prints")
    table = read_sandboxed("prints", b"x", "run", LIMITS)
    assert table.load([0])[0].tolist() == [1.0, 2.0]
    assert LIMITS.parser_seconds <= 10
    assert LIMITS.parser_memory <= 3 * LIMITS.file


def _install(folder, monkeypatch, parser) -> None:
    """A parser among those of `ident.foreign`, in the processes that are started from here on."""
    import ident.foreign

    kept = folder / "kept" / "ident" / "foreign"
    kept.mkdir(parents=True)
    for name in ("__init__", "__main__"):
        (kept / f"{name}.py").write_text(open(f"{ident.foreign.__path__[0]}/{name}.py").read())  # noqa: SIM115
    (kept.parent / "__init__.py").touch()
    (kept / f"{parser}.py").write_text(PARSERS[parser])
    monkeypatch.syspath_prepend(str(folder / "kept"))


def test_a_record_of_diadem_is_the_same_from_a_folder_an_archive_and_by_itself(tmp_path):
    """The files beside it are in its hash, in any letters of their names; one that is short is refused."""
    import shutil

    for name, data in {"run.dat": diadem(), **BESIDE["diadem"]}.items():
        (tmp_path / "matrix" / name).parent.mkdir(exist_ok=True)
        (tmp_path / "matrix" / name).write_bytes(data)
    (tmp_path / "matrix" / "matrix.yaml").write_text(DESCRIBED.format(ending=".dat", time="time", u="u", x="x"))
    folder = read_matrix(tmp_path / "matrix")
    assert read_matrix(shutil.make_archive(str(tmp_path / "packed"), "zip", tmp_path / "matrix")).data_hash == (
        folder.data_hash
    )
    stated = {"units": {"command": "V", "displacement": "mm"}, "columns": {"command": "u", "displacement": "x"}}
    alone = read_matrix(tmp_path / "matrix" / "run.dat", time={"column": "time", "unit": "s"}, **stated)
    np.testing.assert_array_equal(alone.runs[0].measured, folder.runs[0].measured)
    samples = tmp_path / "matrix" / "run.r64"
    samples.write_bytes(samples.read_bytes()[:-8] + bytes(8))
    assert read_matrix(tmp_path / "matrix").data_hash != folder.data_hash
    samples.write_bytes(samples.read_bytes()[:-8])
    with pytest.raises(Unusable, match=r"run\.r64 holds 15 values of channel 'x', the head says 16"):
        read_matrix(tmp_path / "matrix")


SECONDS = 10.0
"""Of the processor, that a file may take; a process of its own is ended after as long."""


def test_a_file_with_bytes_changed_at_random_is_refused_or_read(form, full):
    """A thousand times each; in the short form 8, or 2 where a process is started for each.

    Within ten seconds each, and all within three times the memory that a file may have.
    """
    ending, made, _ = FILES[form]
    whole = np.frombuffer(made(), np.uint8)
    random = np.random.default_rng(7)
    for _ in range(1000 if full else 2 if form in APART else 8):
        damaged = whole.copy()
        places = random.integers(0, random.choice([len(whole), min(300, len(whole))]), random.integers(1, 6))
        damaged[places] = random.choice([0, 255, 48, 57, 10, *random.integers(0, 256, 8)], len(places))
        if random.random() < 0.2:
            damaged = damaged[: random.integers(1, len(whole))]
        began = time.process_time()
        refused = refusal(damaged.tobytes(), f"run{ending}", form)
        assert time.process_time() - began < SECONDS
        if refused is not None:
            assert "\n" not in str(refused)
            assert all((refused.code, refused.what, refused.where, refused.remedy))
    assert most_memory() < 3 * LIMITS.file


def most_memory() -> int:
    """Bytes that this process or one that it started has had at most; nothing where the system does not tell."""
    try:
        import resource
    except ImportError:
        return 0
    who = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    return max(1024 * resource.getrusage(one).ru_maxrss for one in who)


def refusal(data, name, form) -> Unusable | None:
    """Why the file is refused; nothing where it is read."""
    try:
        table = read_table(data, name, FOUND, LIMITS, near=lambda asked: beside(asked, form))
        table.load(range(len(table.names)))
    except Unusable as refused:
        return refused
    return None


def beside(name, form) -> bytes:
    """A file beside one of that form; one that is not there is missing, as in a folder."""
    from ident.readers.source import alone

    found = BESIDE.get(form, {}).get(name.lower())
    return alone(name) if found is None else found


def test_the_sample_rate_and_the_units_that_an_object_of_columns_states_are_found():
    """In Hz, or as the time between samples; what is no such entry, or differs in length, is none."""
    held = {"sample_rate": 500, "units": {"x": "mm"}, "operator": "A", "u": U, "x": X}
    table = read_table(json.dumps(held).encode(), "run.json", FOUND, LIMITS)
    assert (table.names, table.units, table.rate) == (("u", "x"), ("", "mm"), 500.0)
    stepped = read_table(json.dumps({"dt": 0.002, "u": U, "x": X}).encode(), "run.json", FOUND, LIMITS)
    assert stepped.rate == pytest.approx(500.0)
    assert read_table(json.dumps({"fs": "fast", "u": U, "x": X}).encode(), "run.json", FOUND, LIMITS).rate == 0.0
    with pytest.raises(Unusable, match="columns of one length"):
        read_table(json.dumps({"fs": 1, "u": U[1:], "x": X}).encode(), "run.json", FOUND, LIMITS)
