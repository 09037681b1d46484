"""A step of preprocessing: what it does to the data before anything is fitted, when, and by which thresholds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ident.matrix import Matrix
from ident.presets.preset import Preset


@dataclass(frozen=True)
class Threshold:
    """A number that decides whether a step applies: `value` in `unit`, what it means, and the reason for it."""

    value: float
    unit: str
    meaning: str
    reason: str


@dataclass(frozen=True)
class Prepared:
    """A matrix, and the model that is to be fitted to it; None before one is chosen."""

    matrix: Matrix
    preset: Preset | None = None

    @property
    def model(self) -> Preset:
        """The model, for a step that needs one."""
        assert self.preset is not None
        return self.preset


Act = Callable[[Prepared], tuple[Prepared, tuple[str, ...]]]
"""What a step makes of a matrix and a model, and what it says of that in sentences: none where it does not apply."""


@dataclass(frozen=True)
class Step:
    """One step by its `name`, which ``--no-NAME`` and ``preprocessing: {"NAME": false}`` switch off.

    `does` and `applies` say what it changes and when, `without` how the data are taken where it is switched off.
    `act` carries it out, `off` what there is to do where it is switched off. A step that `needs_model` comes after the
    model is chosen. What is `noted` stands among the notes of a result too, not only with its preprocessing.
    """

    name: str
    does: str
    applies: str
    without: str
    thresholds: tuple[Threshold, ...]
    act: Act
    off: Callable[[Prepared], Prepared] = lambda prepared: prepared
    needs_model: bool = True
    noted: bool = True
