"""A matrix in one .zip, read member by member without unpacking to disk."""

from __future__ import annotations

import stat
import zipfile
from pathlib import Path, PurePosixPath
from typing import BinaryIO

from ident.errors import Unusable
from ident.readers.limits import LIMITS, Limits, check_size
from ident.readers.source import DESCRIPTION, inside

METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)  # the others can ask for gigabytes of dictionary
ENCRYPTED = 1


class Archive:
    """A zip archive whose every member has been looked at: names, links, declared sizes, ratios."""

    def __init__(self, file: Path | BinaryIO, name: str, limits: Limits = LIMITS) -> None:
        self.name, self.limits = name, limits
        try:
            self.zip = zipfile.ZipFile(file)
        except FileNotFoundError:
            raise Unusable(
                "missing-file",
                "there is no such file or folder",
                name,
                "give a data set: a folder, its matrix.yaml, or a .zip",
            ) from None
        except Exception as error:  # a broken archive fails in many ways, struct.error and OverflowError among them
            raise not_a_zip(name) from error
        members = [member for member in self.zip.infolist() if not member.is_dir()]
        check_members(members, name, limits)
        self.members = {member.filename: member for member in members}
        self.root = self.find_root()

    def find_root(self) -> str:
        """The folder that holds the description: the top, or the one folder that was packed as a whole."""
        if DESCRIPTION in self.members:
            return ""
        paths = [PurePosixPath(member) for member in self.members]
        found = [path.parts[0] + "/" for path in paths if len(path.parts) == 2 and path.name == DESCRIPTION]
        return found[0] if len(found) == 1 else ""

    def read(self, name: str, limit: int) -> bytes:
        """The bytes of a member, never more than it declared."""
        member = self.members.get(self.root + inside(name, name))
        if member is None:
            raise Unusable("missing-file", "there is no such file", name, "add it or correct the name")
        check_size(member.file_size, limit, "the file", name)
        try:
            with self.zip.open(member) as file:
                return file.read(member.file_size)
        except Exception as error:
            raise Unusable("broken-zip", "this member cannot be unpacked", name, "pack the folder again") from error

    def close(self) -> None:
        """Close the file."""
        self.zip.close()


def not_a_zip(name: str) -> Unusable:
    """The error for a file that is no archive."""
    return Unusable("not-a-zip", "this is not a zip archive", name, "pack the matrix folder as .zip")


def check_members(members: list[zipfile.ZipInfo], name: str, limits: Limits) -> None:
    """Look at every member before any is read."""
    if len(members) > limits.members:
        what = f"{len(members)} files where {limits.members} are allowed"
        raise Unusable("too-large", what, name, "pack only the matrix")
    if len({member.filename for member in members}) < len(members):
        raise Unusable("duplicate-file", "two members have one name", name, "pack the folder again")
    for member in members:
        check_member(member, limits)
    check_size(sum(member.file_size for member in members), limits.total, "the unpacked archive", name)


def check_member(member: zipfile.ZipInfo, limits: Limits) -> None:
    """Refuse traversal, links, encryption, unusual methods and bombs."""
    name = member.filename
    inside(name, f"zip member {name!r}")
    if stat.S_ISLNK(member.external_attr >> 16):
        raise Unusable("symbolic-link", "the archive holds a symbolic link", name, "pack the file itself")
    if member.flag_bits & ENCRYPTED:
        raise Unusable("encrypted-zip", "the archive is encrypted", name, "pack it without a password")
    if member.compress_type not in METHODS:
        raise Unusable("zip-method", "the compression method is not supported", name, "pack with deflate or store")
    packed = max(member.compress_size, 1)
    if member.file_size > max(limits.ratio_from, limits.ratio * packed):
        what = f"it unpacks to {member.file_size / packed:.0f} times its size"
        raise Unusable("zip-bomb", what, name, "pack measured data only")
