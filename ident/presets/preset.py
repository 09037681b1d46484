"""A preset: one paper's model with the plan of its search, the data that it needs, and how it is shown."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from ident.cached import cached_property
from ident.chain.channels import refuse_unmeasured
from ident.chain.disturbance import disturbed
from ident.chain.measured_conditions import with_measured_conditions
from ident.errors import Unusable
from ident.matrix import Matrix
from ident.parameter import Parameter
from ident.presets.display import Display
from ident.presets.model import Combined, Model
from ident.presets.record_units import RecordUnits
from ident.presets.required_data import RequiredData, refuse_unstated
from ident.presets.search_plan import SearchPlan
from ident.run import DISTURBANCES, KINEMATIC, MOTIONS
from ident.stages import OPENED_BY_COMMAND, Scale
from ident.stages.scale import OF_THE_RUNS

__all__ = ["Combined", "Display", "Preset", "RequiredData", "SearchPlan"]


@dataclass(frozen=True)
class Preset(Model):
    """A model, and what else is known of it: `search`, `data` and `display`.

    Raises Unusable as a :class:`Model` does, and where a scale reads what no stage brings, or scales read each other in
    a circle.
    """

    search: SearchPlan = field(default_factory=SearchPlan)
    data: RequiredData = field(default_factory=RequiredData)
    display: Display = field(default_factory=Display)
    under_control: Preset | None = None
    """The same machine under a controller."""
    opened: Preset | None = None
    """The same machine where a command that is no way opens its valve."""

    def __post_init__(self) -> None:
        super().__post_init__()
        for scale in (*self.scales, *self.search.by_outputs):
            if strange := scale.equation.names - self.known - OF_THE_RUNS:
                where = f"preset {self.name}, scale of {scale.name}"
                raise Unusable(
                    "bad-preset",
                    f"no stage brings {', '.join(sorted(strange))}, read by a scale",
                    where,
                    "measure it by something else",
                )

    @property
    def _stated_otherwise(self) -> frozenset[str]:
        return self.search.named

    @cached_property
    def scales(self) -> tuple[Scale, ...]:
        """How its parameters are searched for a machine of unknown size, in the order of the search."""
        return self.search.scales(self)

    def scales_by(self, output: str) -> tuple[Scale, ...]:
        """The same where the machine is measured by this channel."""
        return self.search.scales(self, output)

    @property
    def imposed(self) -> Mapping[str, str]:
        """The states that go with what moves the machine, and the channels that may have recorded them."""
        moved = self.data.driven_by in MOTIONS and "x" in self.chain.states
        return {"x": "displacement"} if moved else {}

    def unit(self, parameter: Parameter) -> str:
        """The unit of a parameter as it is shown."""
        return self.display.unit(self, parameter)

    def combined_unit(self, combined: Combined) -> str:
        """The unit of a combination as it is shown."""
        return self.display.combined_unit(self, combined)

    def parameter(self, name: str) -> Parameter:
        """As :meth:`Model.parameter`; also one that it has under control."""
        try:
            return super().parameter(name)
        except Unusable:
            if self.under_control is None:
                raise
        return self.under_control.with_effects(self.effects).parameter(name)

    def for_matrix(self, matrix: Matrix, load: str = "none") -> tuple[Preset, Matrix]:
        """The model that suits a matrix, and the matrix with what drives that model as its command.

        With `load` "force" no disturbance may be measured beside the force. The data are as they were recorded:
        :func:`ident.preprocessing.prepare` goes on from here. Raises Unusable where the model does not suit them.
        """
        preset = self._driven_as(matrix)
        refuse_unmeasured(preset.chain.symbols, matrix.runs)
        refuse_unstated(preset.data.needs, matrix)
        if matrix.controller is not None and self.under_control is not None:
            preset = self.under_control.with_effects(self.effects)
        if "Kp" in preset.data.gains:
            known = preset.data.gains["Kp"]
            stated = (run if run.gain is not None else replace(run, gain=known) for run in matrix.runs)
            matrix = replace(matrix, runs=tuple(stated))
        if preset.data.driven_by != "command":
            matrix = replace(matrix, runs=tuple(run.driven_by(preset.data.driven_by) for run in matrix.runs))
        elif OPENED_BY_COMMAND in preset.chain.stages and matrix.runs:
            unit = matrix.runs[0].units.get("command", "m")
            preset = replace(preset, display=replace(preset.display, drive_unit=unit))
        way = preset.chain.outputs.get("displacement")
        shown = {run.output for run in matrix.runs}
        as_way = "displacement" not in shown and {preset.chain.outputs.get(name, "") for name in shown} == {way}
        recorded = RecordUnits.of(matrix.runs, preset.data.driven_by, as_way)
        preset = replace(preset, display=replace(preset.display, recorded=recorded))
        if preset.data.area:
            preset = preset._of_area(matrix)
        if preset.search.force_scale and {run.output for run in matrix.runs} == {"load_pressure"}:
            # Its forces are measured.
            preset = replace(preset, search=replace(preset.search, force_scale="A*X"))
        if "displacement" in preset.chain.outputs and any(run.output not in KINEMATIC for run in matrix.runs):
            # A force or a pressure is known beside the motion.
            preset = replace(preset, data=replace(preset.data, share_force=()))
        preset = preset.disturbed_as(matrix, load)
        if preset.kind == "chain":
            preset = replace(preset, chain=with_measured_conditions(preset.chain, matrix.runs))
        return preset, matrix

    def _driven_as(self, matrix: Matrix) -> Preset:
        """The machine in open loop where the command is no way. Raises Unusable where runs differ in that."""
        loops = {run.units.get("command") in _WAYS for run in matrix.runs if "command" in run.channels}
        if self.opened is None or loops <= {True}:
            return self
        if len(loops) > 1:
            raise Unusable(
                "bad-command",
                "runs with a command in m and others in V",
                "command",
                "fit the open and the closed loop one after the other",
            )
        return self.opened.with_effects(self.effects)

    def _of_area(self, matrix: Matrix) -> Preset:
        """The machine with its stated piston area, which is that of a motion along a way.

        Without one a specimen of known mass, spring or damper tells the area. Without either no force is known, and
        each is shown as the pressure that balances it.
        """
        preset, area = self, matrix.actuator.piston_area
        along = {run.units.get(run.output) for run in matrix.runs} <= {"m", "m/s"}
        if area is None or not along:
            if any(run.specimen is not None and run.specimen.scales_forces for run in matrix.of_use("fit")):
                return replace(self, without_area=None)
            area = 1.0
            recorded = replace(self.display.recorded, pressed=True)
            preset = replace(self, display=replace(self.display, recorded=recorded))
        return replace(preset, data=replace(preset.data, gains={**preset.data.gains, self.data.area: area}))

    def disturbed_as(self, matrix: Matrix, load: str) -> Preset:
        """The model with what was measured at a place beside the command, as it is where nothing was.

        Raises Unusable where runs are disturbed at several places, or the measured force drives the load too.
        """
        places = sorted({DISTURBANCES[name] for run in matrix.runs for name in run.channels if name in DISTURBANCES})
        if not places:
            return self
        if len(places) > 1 or load == "force":
            both = " and ".join((*places, *(["the measured load"] if load == "force" else [])))
            raise Unusable(
                "bad-disturbance", f"two inputs in addition to the command: {both}", "disturbance", "give one"
            )
        chain = disturbed(self.chain, places[0])
        if places[0] == "flow" and matrix.actuator.piston_area is None:
            raise Unusable("missing-area", "a flow moves a piston of unknown area", "actuator.piston_area", "state it")
        return replace(self, chain=chain)


_WAYS = ("m", "rad")
