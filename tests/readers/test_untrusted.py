"""Files made to harm: each is refused by name before anything is unpacked or followed."""

from __future__ import annotations

import io
import os
import stat
import struct
import tracemalloc
import zipfile
import zlib

import numpy as np
import pytest

from ident.errors import Unusable
from ident.readers import read_matrix
from ident.readers.archive import Archive
from ident.readers.limits import Limits

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


def repack(matrix, change) -> io.BytesIO:
    """The archive of a good matrix with one more member."""
    archive = matrix.pack()
    with zipfile.ZipFile(archive, "a", zipfile.ZIP_DEFLATED) as packed:
        change(packed)
    return archive


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
    matrix.write()
    refused = refusal(repack(matrix, lambda packed: packed.writestr(name, "x")))
    assert refused.code == "outside-folder"


def test_a_symbolic_link_in_an_archive_is_refused(matrix):
    matrix.write()
    link = zipfile.ZipInfo("runs/link.csv")
    link.external_attr = (stat.S_IFLNK | 0o777) << 16
    assert refusal(repack(matrix, lambda packed: packed.writestr(link, "/etc/passwd"))).code == "symbolic-link"


def test_two_members_of_one_name_are_refused(matrix):
    matrix.write()
    with pytest.warns(UserWarning, match="Duplicate"):
        archive = repack(matrix, lambda packed: packed.writestr("matrix.yaml", "x"))
    assert refusal(archive).code == "duplicate-file"


def test_an_unusual_compression_is_refused(matrix):
    matrix.write()
    archive = repack(matrix, lambda packed: packed.writestr("x", b"x" * 100, zipfile.ZIP_LZMA))
    assert refusal(archive).code == "zip-method"


def test_a_zip_bomb_is_refused_by_what_it_declares(matrix):
    matrix.write()
    archive = repack(matrix, lambda packed: packed.writestr("runs/bomb.csv", bytes(32 << 20)))
    assert refusal(archive).code == "zip-bomb"


def test_many_members_that_are_too_large_together_are_refused(matrix):
    matrix.write()

    def fill(packed):
        for number in range(12):
            packed.writestr(f"runs/{number}.csv", bytes(1 << 20))

    assert refusal(repack(matrix, fill), Limits(total=10 << 20)).code == "too-large"
    assert refusal(matrix.path.with_suffix(".zip"), Limits(members=5)).code == "too-large"


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
    path = matrix.write()
    run = path / "runs/first.csv"
    run.rename(tmp_path / "outside.csv")
    run.symlink_to(tmp_path / "outside.csv")
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
    path = matrix.write()
    with (path / "runs/first.csv").open("wb") as file:
        file.truncate(2 << 30)  # sparse: takes no disk
    assert refusal(path).code == "too-large"


def test_all_samples_together_are_bounded(matrix):
    assert refusal(matrix.write(), Limits(samples=1000)).code == "too-large"
    assert refusal(matrix.path, Limits(total=1000)).code == "too-large"


# numpy archives


def npy(shape: str, dtype: str = "'<f8'", data: bytes = b"") -> bytes:
    """A .npy that declares what it likes."""
    head = f"{{'descr': {dtype}, 'fortran_order': False, 'shape': {shape}, }}".encode()
    head += b" " * (63 - (len(head) + 10) % 64) + b"\n"
    return b"\x93NUMPY\1\0" + struct.pack("<H", len(head)) + head + data


def with_npz(matrix, member: bytes):
    matrix.change("first.csv", "first.npz").describe()
    with zipfile.ZipFile(matrix.path / "runs/first.npz", "w", zipfile.ZIP_DEFLATED) as packed:
        packed.writestr("u.npy", member)
        packed.writestr("x.npy", member)
    return matrix.path


def test_object_arrays_are_never_unpickled(matrix, tmp_path):
    class Trap:
        def __reduce__(self):
            return (os.mkdir, (str(tmp_path / "sprung"),))

    matrix.change("first.csv", "first.npz").describe()
    trap = np.array([Trap()] * 400, dtype=object)
    np.savez(matrix.path / "runs/first.npz", u=trap, x=np.arange(400.0))
    assert refusal(matrix.path).code == "object-array"
    assert not (tmp_path / "sprung").exists()


@pytest.mark.parametrize(
    ("member", "code"),
    [
        (npy("(1000000000,)"), "too-large"),
        (npy("(20000000,)", data=bytes(1000)), "broken-npz"),
        (npy("(-5,)"), "broken-npz"),
        (npy("(99999999999999999999999,)"), "too-large"),
        (npy("__import__('os').system('true')"), "broken-npz"),
        (npy("(400,)", "'<f8'", bytes(32 << 20)), "broken-npz"),
        (npy("(400,)", "[('a', '<f8')]", bytes(3200)), "not-numeric"),
        (npy("(400,)", "'<M8[s]'", bytes(3200)), "not-numeric"),
        (b"\x93NUMPY\x09\0", "broken-npz"),
        (b"", "broken-npz"),
    ],
)
def test_a_numpy_array_that_declares_what_is_not_there_is_refused(matrix, member, code):
    assert refusal(with_npz(matrix, member)).code == code


# HDF5


def hdf5(matrix, make):
    import h5py

    matrix.change("first.csv", "first.h5").describe()
    with h5py.File(matrix.path / "runs/first.h5", "w") as file:
        file["u"] = np.arange(400.0)
        make(file)
    return matrix.path


def test_links_out_of_an_hdf5_file_are_refused(matrix):
    import h5py

    path = hdf5(matrix, lambda file: file.__setitem__("x", h5py.ExternalLink("/etc/passwd", "/x")))
    refused = refusal(path)
    assert refused.code == "hdf5-link"
    assert "another file" in str(refused)
    matrix.text = matrix.text.replace("first.h5", "first.csv")
    assert refusal(hdf5(matrix, lambda file: file.__setitem__("x", h5py.SoftLink("/u")))).code == "hdf5-link"


def test_virtual_and_external_datasets_are_refused(matrix):
    import h5py

    def virtual(file):
        layout = h5py.VirtualLayout((400,), "f8")
        layout[:] = h5py.VirtualSource("/etc/passwd", "x", (400,))
        file.create_virtual_dataset("x", layout)

    def external(file):
        file.create_dataset("x", (400,), "f8", external=[("/etc/passwd", 0, 3200)])

    assert refusal(hdf5(matrix, virtual)).code == "hdf5-virtual"
    matrix.text = matrix.text.replace("first.h5", "first.csv")
    assert refusal(hdf5(matrix, external)).code == "hdf5-external"


def test_hdf5_declarations_beyond_the_limits_are_refused(matrix):
    def huge(file):
        file.create_dataset("x", (1 << 40,), "f8", chunks=(1 << 20,), compression="gzip")

    assert refusal(hdf5(matrix, huge)).code == "too-large"
    matrix.text = matrix.text.replace("first.h5", "first.csv")

    def chunk(file):
        file.create_dataset("x", (1 << 26,), "f8", chunks=(1 << 26,), compression="gzip")

    assert refusal(hdf5(matrix, chunk), Limits(channel=100 << 20)).code == "too-large"


def test_an_hdf5_chunk_that_unpacks_to_more_than_its_size_is_refused(matrix):
    def bomb(file):
        data = file.create_dataset("x", (400,), "f8", chunks=(400,), compression="gzip")
        data.id.write_direct_chunk((0,), zlib.compress(bytes(200 << 20), 9))

    assert refusal(hdf5(matrix, bomb)).code == "broken-hdf5"


def test_a_group_that_contains_itself_ends(matrix):
    def ring(file):
        file["x"] = np.arange(400.0)
        file.create_group("loop")["back"] = file["/"]

    assert read_matrix(hdf5(matrix, ring)).runs[0].length == 400


def test_an_unknown_compression_of_hdf5_is_refused(matrix):
    def odd(file):
        file.create_dataset("x", data=np.arange(400), chunks=(400,), scaleoffset=0)

    assert refusal(hdf5(matrix, odd)).code == "hdf5-filter"


# MATLAB


def mat5(matrix, element: bytes):
    matrix.change("first.csv", "first.mat").describe()
    head = b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM"
    (matrix.path / "runs/first.mat").write_bytes(head + element)
    return matrix.path


@pytest.mark.parametrize(
    ("inside", "code"),
    [
        (struct.pack("<II", 14, 0xFFFFFFF0) + bytes(1000), "too-large"),
        (struct.pack("<II", 14, 1000) + bytes(200 << 20), "broken-mat"),
        (struct.pack("<II", 14, 100 << 20) + bytes(1000), "broken-mat"),
        (b"", "broken-mat"),
    ],
)
def test_a_compressed_matlab_variable_unpacks_to_what_it_declares_or_not_at_all(matrix, inside, code):
    packed = zlib.compress(inside, 9)
    assert refusal(mat5(matrix, struct.pack("<II", 15, len(packed)) + packed)).code == code


# Parquet


def test_parquet_that_declares_too_much_is_refused(matrix):
    import pyarrow as pa
    from pyarrow import parquet

    matrix.change("first.csv", "first.parquet").describe()
    data = pa.table({"u": np.zeros(2_000_000), "x": np.zeros(2_000_000)})
    parquet.write_table(data, matrix.path / "runs/first.parquet")
    assert (matrix.path / "runs/first.parquet").stat().st_size < 20_000
    assert refusal(matrix.path, Limits(channel=8 << 20)).code == "too-large"


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
