"""The fits of a folder of matrices: one after the other, and a table of all."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from app.cli.output import STANDARD_OUTPUT, write_json
from app.cli.progress import shown
from ident.errors import Unusable

if TYPE_CHECKING:
    from ident.fit.result import FitResult
    from ident.progress import Report

UNUSABLE = 2


def matrices_in(folder: Path) -> tuple[Path, ...]:
    """The matrix folders and archives in a folder that is no matrix itself, by name; else none."""
    from ident.readers.source import DESCRIPTION

    if not folder.is_dir() or (folder / DESCRIPTION).exists():
        return ()
    return tuple(path for path in sorted(folder.iterdir()) if path.suffix == ".zip" or (path / DESCRIPTION).is_file())


def fit_each(matrices: Sequence[Path], fitted: Callable[[Path, Report], FitResult], json: Path | None) -> None:
    """Fit each; what cannot be used is said in its line, the others go on, and the exit status is 2."""
    found: dict[str, FitResult | Unusable] = {}
    with shown() as report:
        for path in matrices:
            try:
                found[path.name] = fitted(path, report)
            except Unusable as refused:
                found[path.name] = refused
    if json is not None:
        entries = [
            {"matrix": name, "refused": str(one)}
            if isinstance(one, Unusable)
            else {"matrix": name, "fit": one.to_json()}
            for name, one in found.items()
        ]
        write_json({"fits": entries}, json)
    if json != STANDARD_OUTPUT:
        show_each(found)
    if any(isinstance(one, Unusable) for one in found.values()):
        raise typer.Exit(UNUSABLE)


def show_each(found: dict[str, FitResult | Unusable]) -> None:
    """Print a line a matrix: the actuator, the model, its errors and floor, its parameters, or why there is no fit."""
    from app.cli.tables import output, table
    from ident.words.engineering import quantity
    from ident.words.percent import percent

    header = ("matrix", "serial", "model", "fit", "verify", "noise floor", "parameters")
    rows: list[tuple[str, ...]] = []
    for name, one in found.items():
        if isinstance(one, Unusable):
            rows.append((name, "–", "–", "–", "–", "–", str(one)))
            continue
        values = ", ".join(f"{symbol} {quantity(entry.value, entry.unit)}" for symbol, entry in one.parameters.items())
        errors = (*(one.error_of(use).said() for use in ("fit", "verify")), percent(one.noise_floor.get("fit")))
        serial = one.actuator.serial if one.actuator else "–"
        rows.append((name, serial, " + ".join((one.model, *one.effects)), *errors, values))
    output().print(table(header, rows, numbers=header[3:6]))
