"""The options that choose a fit, for every command that makes one, and the settings that they are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.arguments import additions, method_options, names_of
from app.cli.arguments import bounds as read_bounds
from app.cli.arguments import values as read_values
from ident.fit.settings import METHODS

if TYPE_CHECKING:
    from ident.diagnosis.structure_selection import StructureChoice
    from ident.fit.settings import Settings
    from ident.matrix import Matrix
    from ident.progress import Report

_LARGEST = 65_536  # bytes of a file that describes a machine
MatrixPath = Annotated[Path, typer.Argument(metavar="MATRIX", help="Data set: a folder, its matrix.yaml, or a .zip.")]
Model = Annotated[
    str | None,
    typer.Option(
        metavar="NAME|FILE.yaml",
        help="Model to identify, or a file that defines one from stages. Default: automatic selection.",
    ),
]
Effects = Annotated[
    list[str] | None,
    typer.Option("--effect", metavar="NAME", help="Effect to add, from the library or saved; may be repeated."),
]
Custom = Annotated[
    list[Path] | None,
    typer.Option(
        "--custom",
        metavar="EFFECT.yaml|NAME",
        help="Own effect to add: a file, a saved name, or the terms that a diagnosis (D.json) proposes; may be "
        "repeated.",
    ),
]
Terms = Annotated[
    int | None,
    typer.Option(
        "--terms",
        metavar="N",
        help="Use only the first N proposed terms of a diagnosis (with --start also 0).",
    ),
]
StartFile = Annotated[
    Path | None,
    typer.Option(
        "--start",
        metavar="FILE.json|last",
        help="Start from the result of a fit or a diagnosis, with its model, effects, terms, windows and runs; last is "
        "the latest diagnosis of these data. "
        "--effect selects another candidate of a diagnosis.",
    ),
]
AlsoSearch = Annotated[
    bool, typer.Option("--search", help="With --start: also search the whole space, and use the better result.")
]
Ranked = Annotated[
    list[Path] | None,
    typer.Option(
        "--custom",
        metavar="EFFECT.yaml|NAME",
        help="Own effect to rank with the library: a file or a saved name; may be repeated.",
    ),
]
Method = Annotated[str, typer.Option(help=f"One of {', '.join(METHODS)}.")]
Bounds = Annotated[
    list[str] | None,
    typer.Option(metavar="NAME=LO:HI", help="Bounds of a parameter, in SI or with units; may be repeated."),
]
Values = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="NAME=VALUE", help="Fix a parameter, in SI or with a unit; may be repeated."),
]
Load = Annotated[str, typer.Option(help="force: drive the load by the measured force; none: use the specimen model.")]
Seed = Annotated[int, typer.Option(min=0, max=2**31 - 1, help="Random seed. The same seed gives the same result.")]
Budget = Annotated[
    float | None,
    typer.Option(metavar="SECONDS", help="Time limit in s of the search. A fit that it stops cannot be approved."),
]
Profiled = Annotated[
    list[str] | None,
    typer.Option("--profile", metavar="NAME", help="Compute the profile likelihood of a parameter; may be repeated."),
]
Options = Annotated[
    list[str] | None,
    typer.Option("--option", metavar="NAME=VALUE", help="Option of the method, such as keep=0.5; may be repeated."),
]


def modelled(
    matrix: Matrix, model: str | None, report: Report, preprocessing: Mapping[str, bool]
) -> tuple[str, StructureChoice]:
    """The model that was named; else the one that fits, and what was found on the way to it.

    Raises Unusable where the channels allow none.
    """
    from ident.diagnosis.structure_selection import StructureChoice, choose_structure

    if model is not None:
        return _named(model), StructureChoice(matrix)
    choice = choose_structure(matrix, report, preprocessing)
    return choice.structures[0].machine, choice


def _named(model: str) -> str:
    """The name of a model; of a file that puts one together from stages the machine's. Raises Unusable."""
    from ident.presets import preset
    from ident.presets.description import described
    from ident.readers.source import read_regular
    from ident.readers.strict_yaml import read_yaml

    if not model.endswith((".yaml", ".yml")):
        return model
    data = read_yaml(read_regular(Path(model), model, _LARGEST), model)
    inner = data.get("machine", data) if isinstance(data, dict) else data
    return preset(described(inner, model).name).name


def settings(
    model: str,
    effect: list[str] | None,
    method: str,
    bounds: list[str] | None,
    set_: list[str] | None,
    load: str,
    seed: int,
    option: list[str] | None,
    custom: list[Path] | None = None,
    budget: float | None = None,
    terms: int | None = None,
    preprocessing: Mapping[str, bool] | None = None,
    candidates: bool = False,
) -> Settings:
    """The library's settings from what the command line gives. Raises Unusable.

    With `candidates` bounds and values may be of effects, too, that a diagnosis may add to the model.
    """
    from app.cli.local_effects import defined_here
    from ident.custom.definition import preset_with
    from ident.diagnosis.named import with_named
    from ident.fit.parameter_bounds import with_candidates
    from ident.fit.settings import Settings

    own, found = additions(custom or [], terms)
    base = Settings(
        model=model,
        method=method,
        load=load,
        seed=seed,
        options=method_options(option or []),
        budget=budget,
        preprocessing=preprocessing or {},
    )
    named = dict.fromkeys((*(effect or []), *own.effects))
    chosen = with_named(base, tuple(named), own.custom, found, defined_here)
    preset = preset_with(model, chosen.effects, chosen.custom)
    if candidates:
        preset = with_candidates(preset, names_of((*(bounds or []), *(set_ or []))), chosen.custom)
    return replace(chosen, bounds=read_bounds(bounds or [], preset), fixed=read_values(set_ or [], preset))
