"""How the parameters of a model are searched: in which order, over which ranges, by which methods."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ident.presets.effect_scales import scale_of
from ident.presets.model import Model, in_order
from ident.stages import OPENED_BY_COMMAND, Scale
from ident.stages.scale import in_reading_order

_TIME = "max(1/W, H/6)"  # a step may be late by half the time that it is held


@dataclass(frozen=True)
class SearchPlan:
    """The order and the ranges of a search, beside the scales that the stages bring."""

    order: tuple[str, ...] = ()
    """Parameters that are searched first; then the others as results list them, each after those that it reads."""
    rescaled: tuple[Scale, ...] = ()
    """Take the place of the stages' scales, where a machine is measured otherwise."""
    rescaled_by_output: Mapping[str, tuple[Scale, ...]] = field(default_factory=dict)
    """Take theirs where the machine is measured by this channel."""
    bounds_hold_for: float | None = None
    """Piston area (m²) of the machine that the parameters' bounds were stated for; others are searched over scales."""
    force_scale: str = ""
    """Size of the forces, in the words of a scale; "" where the model has none."""
    drive_scale: str = ""
    """Size of the drive signal; "" is the motion times the gain."""
    relative_ways: bool = False
    """Whether lengths of effects' shapes are measured by the motion."""
    methods: tuple[str, ...] = ()
    """Fitting methods of this model alone."""
    options: Mapping[str, float] = field(default_factory=dict)
    """Options of the genetic search that differ from the usual ones."""

    @property
    def named(self) -> frozenset[str]:
        """The parameters of which something is stated."""
        return frozenset((*self.order, *(scale.name for scale in (*self.rescaled, *self.by_outputs))))

    @property
    def by_outputs(self) -> tuple[Scale, ...]:
        """The scales of every channel by which a machine may be measured."""
        return tuple(scale for scales in self.rescaled_by_output.values() for scale in scales)

    def scales(self, model: Model, output: str = "") -> tuple[Scale, ...]:
        """How the parameters of a model of unknown size are searched, in the order of the search."""
        found = {scale.name: scale for stage in model.chain.stages for scale in stage.scales}
        found |= {scale.name: scale for scale in self.rescaled}
        found |= {scale.name: scale for scale in self.rescaled_by_output.get(output, ())}
        sizes = self._sizes(model)
        found |= {p.in_equations: scale_of(effect, p, sizes) for effect in model.effects for p in effect.added}
        return in_reading_order(in_order(found, (*self.order, *(p.in_equations for p in model.parameters))))

    def _sizes(self, model: Model) -> dict[str, str]:
        """Of drive signal, its zones, force and time, in the words of a scale: see :func:`scale_of`."""
        drive = self.drive_scale or "Kp*L"
        widest = "0.9*M" if OPENED_BY_COMMAND in model.chain.stages else f"1.2*{drive}"
        return {"D": drive, "Z": widest, "F": self.force_scale, "T": _TIME}
