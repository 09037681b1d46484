"""`servoident join`: files of one signal each as one table, which is a run."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.cli.output import check_target, write_bytes
from ident.errors import Unusable


def join(
    files: Annotated[list[Path], typer.Argument(metavar="FILES…", help="Files of one run, one signal per file.")],
    out: Annotated[Path, typer.Option(metavar="FILE", help="Table to write, such as run.csv.")],
) -> None:
    """Join the signals of several files into one table.

    `servoident init` then describes the table.
    """
    from ident.drafts.joined_files import joined
    from ident.drafts.raw_file import read_whole
    from ident.readers.limits import LIMITS
    from ident.readers.source import read_regular

    check_target(out)
    if out.exists():
        raise Unusable("there-already", "the file exists", str(out), "name another with --out")
    names = [file.name for file in files]
    if len(set(names)) < len(names) or len(names) == 1:
        raise Unusable("bad-option", "give two files or more, each with a name of its own", "join", "name each once")
    text = joined({file.name: read_whole(read_regular(file, file.name, LIMITS.file), file.name) for file in files})
    write_bytes(text.encode(), out)
    print(f"wrote {out}; next: servoident init {out}")
