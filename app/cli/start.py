"""`fit --start FILE.json`: the settings of a fit that begins where a fit or a diagnosis ended."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.arguments import method_options
from app.cli.input_files import read_result
from app.cli.last_diagnosis import found_file
from ident.errors import Unusable

if TYPE_CHECKING:
    from ident.fit.settings import Settings
    from ident.matrix import Matrix


@dataclass(frozen=True)
class Searched:
    """How the whole space is to be searched in addition to the start; as usual where nothing is said."""

    method: str = "ga"
    seed: int = 0
    option: Sequence[str] = ()
    budget: float | None = None


@dataclass(frozen=True)
class StartOptions:
    """What the command line says about a start: the file, which of its models, and what else was given.

    `searched` is None where nothing but the start is refined; `others` are options that the file has decided, by name,
    with what was given for each.
    """

    file: Path
    effects: Sequence[str] = ()
    terms: int | None = None
    search: bool = False
    searched: Searched = field(default_factory=Searched)
    others: Mapping[str, object] = field(default_factory=dict)

    def check(self) -> None:
        """Raise Unusable where options are given that do not go together."""
        given = [name for name, value in self.others.items() if value]
        if given:
            raise Unusable(
                "bad-option",
                f"{' and '.join(given)} cannot be given with a start",
                "--start",
                "leave out what the file decides: model, effects, bounds and values",
            )
        if not self.search and self.searched != Searched():
            raise Unusable(
                "bad-option",
                "options of a search are given, and no search is made",
                "--start",
                "add --search, or leave out --method, --seed, --option and --budget",
            )

    def settings(self, matrix: Matrix) -> Settings:
        """The settings of the fit of a matrix that the file leads to. Raises Unusable."""
        from ident.diagnosis.recommended import settings_after

        file = found_file(self.file, matrix)
        found = settings_after(read_result(file), self.effects, self.terms, self.search)
        if not self.search:
            return found
        how = self.searched
        options = method_options(list(how.option))
        return replace(found, method=how.method, seed=how.seed, options=options, budget=how.budget)
