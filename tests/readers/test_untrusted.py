"""Files made to harm: each is refused by name before anything is unpacked or followed."""

from __future__ import annotations

import io
import os
import struct
import tracemalloc
import zipfile

import numpy as np
import pytest

from ident.errors import Unusable
from ident.readers import read_matrix
from ident.readers.archive import Archive
from ident.readers.limits import Limits
from tests import bad_inputs as bad
from tests.bad_inputs import npy

FEW = 64 << 20  # bytes that reading a refused file may take at most


def refusal(path, limits=Limits()):  # noqa: B008
    tracemalloc.start()
    with pytest.raises(Unusable) as refused:
        read_matrix(path, limits)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < FEW
    assert "\n" not in str(refused.value)
    return refused.value


@pytest.mark.parametrize("content", [b"", b"not a zip", b"PK\3\4" + bytes(100), b"PK\5\6" + b"\xff" * 18])
def test_what_is_no_archive_is_refused(tmp_path, content):
    path = tmp_path / "matrix.zip"
    path.write_bytes(content)
    assert refusal(path).code == "not-a-zip"


def test_a_path_that_does_not_exist_is_refused(tmp_path):
    for name in ("matrix.zip", "nothing", "nothing/matrix.yaml"):
        assert refusal(tmp_path / name).code == "missing-file"


@pytest.mark.parametrize("name", ["../evil", "/evil", "a/../../evil", "a\\evil", "C:evil", "runs/../../x"])
def test_a_member_that_leaves_the_archive_is_refused(matrix, name):
    assert refusal(bad.with_member(name, "x")(matrix)).code == "outside-folder"


def test_a_symbolic_link_in_an_archive_is_refused(matrix):
    assert refusal(bad.with_member(bad.link(), "/etc/passwd")(matrix)).code == "symbolic-link"


def test_two_members_of_one_name_are_refused(matrix):
    with pytest.warns(UserWarning, match="Duplicate"):
        archive = bad.with_member("matrix.yaml", "x")(matrix)
    assert refusal(archive).code == "duplicate-file"


def test_an_unusual_compression_is_refused(matrix):
    archive = bad.with_member("runs/y.csv", b"y" * 100)(matrix)
    with zipfile.ZipFile(archive, "a") as packed:
        packed.writestr("x", b"x" * 100, zipfile.ZIP_LZMA)
    assert refusal(archive).code == "zip-method"


def test_a_zip_bomb_is_refused_by_what_it_declares(matrix):
    assert refusal(bad.with_member("runs/bomb.csv", bytes(32 << 20))(matrix)).code == "zip-bomb"


def test_many_members_that_are_too_large_together_are_refused(matrix):
    matrix.write()
    archive = matrix.pack()
    with zipfile.ZipFile(archive, "a", zipfile.ZIP_DEFLATED) as packed:
        for number in range(12):
            packed.writestr(f"runs/{number}.csv", bytes(1 << 20))
    assert refusal(archive, Limits(total=10 << 20)).code == "too-large"
    assert refusal(archive, Limits(members=5)).code == "too-large"


def test_a_member_that_lies_about_its_size_is_refused(matrix):
    matrix.write()
    archive = matrix.pack()
    raw = bytearray(archive.read_bytes())
    at = raw.rfind(b"PK\1\2")  # the directory's last entry: a run file
    assert b"first.csv" in raw[at:]
    raw[at + 24 : at + 28] = struct.pack("<I", 100)
    archive.write_bytes(raw)
    assert refusal(archive).code == "broken-zip"


def test_an_encrypted_member_is_refused(matrix):
    matrix.write()
    archive = matrix.pack()
    raw = bytearray(archive.read_bytes())
    raw[raw.rfind(b"PK\1\2") + 8] |= 1
    archive.write_bytes(raw)
    assert refusal(archive).code == "encrypted-zip"


def test_an_archive_without_a_description_is_refused(tmp_path):
    with zipfile.ZipFile(tmp_path / "matrix.zip", "w") as packed:
        packed.writestr("other.txt", "x")
    assert refusal(tmp_path / "matrix.zip").code == "missing-file"


def test_an_archive_is_read_without_a_file_on_disk(matrix):
    matrix.write()
    archive = Archive(io.BytesIO(matrix.pack().read_bytes()), "upload")
    assert archive.read("runs/first.csv", 1 << 20) == (matrix.path / "runs/first.csv").read_bytes()


def test_symbolic_links_and_devices_in_a_folder_are_refused(matrix, tmp_path):
    path = bad.linked_folder(matrix)
    run = path / "runs/first.csv"
    assert refusal(path).code == "symbolic-link"
    run.unlink()
    os.mkfifo(run)
    assert refusal(path).code == "not-a-file"  # and does not wait for a writer
    run.unlink()
    run.mkdir()
    assert refusal(path).code in ("not-a-file", "unreadable-file")
    run.rmdir()
    (path / "runs").rename(tmp_path / "elsewhere")
    (path / "runs").symlink_to(tmp_path / "elsewhere")
    assert refusal(path).code == "symbolic-link"


def test_a_file_beyond_the_limit_is_refused_unread(matrix):
    assert refusal(bad.sparse(matrix)).code == "too-large"


def test_all_samples_together_are_bounded(matrix):
    assert refusal(matrix.write(), Limits(samples=1000)).code == "too-large"
    assert refusal(matrix.path, Limits(total=1000)).code == "too-large"


# numpy archives


def test_object_arrays_are_never_unpickled(matrix, tmp_path):
    assert refusal(bad.object_array(matrix)).code == "object-array"
    assert not (tmp_path / "sprung").exists()


@pytest.mark.parametrize(
    ("member", "code"),
    [
        (npy("(1000000000,)"), "too-large"),
        (npy("(20000000,)", data=bytes(1000)), "broken-npz"),
        (npy("(-5,)"), "broken-npz"),
        (npy("(99999999999999999999999,)"), "too-large"),
        (npy("__import__('os').system('true')"), "broken-npz"),
        (lambda: npy("(400,)", "'<f8'", bytes(32 << 20)), "broken-npz"),
        (npy("(400,)", "[('a', '<f8')]", bytes(3200)), "not-numeric"),
        (npy("(400,)", "'<M8[s]'", bytes(3200)), "not-numeric"),
        (b"\x93NUMPY\x09\0", "broken-npz"),
        (b"", "broken-npz"),
    ],
)
def test_a_numpy_array_that_declares_what_is_not_there_is_refused(matrix, member, code):
    assert refusal(bad.with_npz(member() if callable(member) else member)(matrix)).code == code


# HDF5


@pytest.mark.parametrize(
    ("make_x", "code"),
    [
        (bad.external_link, "hdf5-link"),
        (bad.soft_link, "hdf5-link"),
        (bad.virtual, "hdf5-virtual"),
        (bad.external_storage, "hdf5-external"),
        (bad.huge, "too-large"),
        (bad.swollen_chunk, "broken-hdf5"),
    ],
)
def test_links_and_declarations_of_an_hdf5_file_are_looked_at_before_its_data(matrix, make_x, code):
    assert refusal(bad.with_hdf5(make_x)(matrix)).code == code


def test_an_external_link_is_named_as_one(matrix):
    assert "another file" in str(refusal(bad.with_hdf5(bad.external_link)(matrix)))


def test_one_chunk_beyond_the_limits_is_refused(matrix):
    def chunk(file):
        file.create_dataset("x", (1 << 26,), "f8", chunks=(1 << 26,), compression="gzip")

    assert refusal(bad.with_hdf5(chunk)(matrix), Limits(channel=100 << 20)).code == "too-large"


def test_a_group_that_contains_itself_ends(matrix):
    def ring(file):
        file["x"] = np.arange(400.0)
        file.create_group("loop")["back"] = file["/"]

    assert read_matrix(bad.with_hdf5(ring)(matrix)).runs[0].length == 400


def test_an_unknown_compression_of_hdf5_is_refused(matrix):
    def odd(file):
        file.create_dataset("x", data=np.arange(400), chunks=(400,), scaleoffset=0)

    assert refusal(bad.with_hdf5(odd)(matrix)).code == "hdf5-filter"


# MATLAB


@pytest.mark.parametrize(
    ("inside", "code"),
    [
        (struct.pack("<II", 14, 0xFFFFFFF0) + bytes(1000), "too-large"),
        (struct.pack("<II", 14, 100 << 20) + bytes(1000), "broken-mat"),
        (b"", "broken-mat"),
    ],
)
def test_a_compressed_matlab_variable_unpacks_to_what_it_declares_or_not_at_all(matrix, inside, code):
    assert refusal(bad.compressed_mat5(inside)(matrix)).code == code


def test_a_compressed_matlab_variable_that_swells_is_not_unpacked(matrix):
    assert refusal(bad.mat5_bomb(matrix)).code == "broken-mat"


# Parquet


def test_parquet_that_declares_too_much_is_refused(matrix):
    path = bad.large_parquet(matrix)
    assert (path / "runs/first.parquet").stat().st_size < 500_000
    assert refusal(path).code == "too-large"


def test_the_pages_of_a_parquet_file_are_counted_not_only_its_footer(matrix):
    import pyarrow as pa
    from pyarrow import parquet

    matrix.change("first.csv", "first.parquet").describe()
    columns = [pa.field(name, pa.float64(), nullable=False) for name in "ux"]
    data = pa.table({name: np.zeros(900) for name in "ux"}, pa.schema(columns))
    path = matrix.path / "runs/first.parquet"
    parquet.write_table(data, path, compression="zstd", use_dictionary=False, column_encoding="PLAIN")
    raw = path.read_bytes()
    honest = b"\x15" + varint(7200 * 2)  # field of a 32-bit number, zigzag
    lie = b"\x15" + varint(8190 * 2)
    assert honest in raw
    assert len(lie) == len(honest)
    path.write_bytes(raw.replace(honest, lie, 1))
    assert refusal(matrix.path, Limits(channel=7200)).code == "too-large"


def varint(number: int) -> bytes:
    parts = []
    while number > 127:
        parts.append(number & 127 | 128)
        number >>= 7
    return bytes([*parts, number])
