"""A preset: one paper's model as a choice of stages, with its parameters and its citation."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal, TypeVar

from ident.cached import cached_property
from ident.chain.chain import Chain
from ident.chain.channels import READABLE, refuse_unmeasured
from ident.chain.conditions import CONDITIONS
from ident.chain.disturbance import disturbed
from ident.chain.refusals import unfit
from ident.chain.varying import varying
from ident.effects.effect import Effect
from ident.equations.equation import Equation
from ident.errors import Unusable
from ident.matrix import Matrix
from ident.parameter import Parameter
from ident.presets.convention import Convention
from ident.presets.effect_scales import scale_of
from ident.presets.middle import about
from ident.presets.record_units import RecordUnits
from ident.presets.stated import refuse_unstated
from ident.run import DISTURBANCES, MOTIONS
from ident.stages import MASS_SPRING_DAMPER, MEASURED_LOAD, OPENED_BY_COMMAND, Scale
from ident.stages.scale import OF_THE_RUNS, in_reading_order
from ident.words.nearest import did_you_mean

Kind = Literal["chain", "bench"]
"""Who serves a model: what fits chains to test runs, or Kononykhin's procedures for the records of a bench."""
T = TypeVar("T")


@dataclass(frozen=True)
class Combined:
    """A combination of parameters that data may determine where its factors are not: `text` in the grammar."""

    text: str
    unit: str
    meaning: str

    @property
    def equation(self) -> Equation:
        """The combination as an equation of the grammar."""
        return Equation(f"combination = {self.text}")


@dataclass(frozen=True)
class Preset:
    """A model by name: the stages of `chain`, with the parameters and scales that they bring.

    `stated` are parameters and `rescaled` scales that take the place of the stages', where a paper states other bounds
    or a machine is measured otherwise; `rescaled_by_position` theirs where a position is recorded. Results
    list the parameters named in `listed` first, then the stated ones, then those of the stages along the chain; a
    search takes those named in `searched` first, then the others as they are listed, each after those that its scale
    reads.

    `bounds_hold_for` is the piston area (m²) of the machine that the parameters' bounds were stated for; another
    machine is searched over `scales`. `without_area` gives the name and unit of what a parameter becomes when the
    area is unknown. `driven_by` is the channel that drives the model, the command where a run has none of that name;
    `under_control` the model of the same machine under a controller. `methods` are fitting methods of this model
    alone; `opened` is the same machine where a command that is no way opens its valve. `alone`: a run that states no
    specimen moves none. `needs` is what must be stated of the actuator, or measured; `steps` those a sample that the
    kinks of its core ask for. `absolute` are outputs whose zero
    is the model's own, so that a fit counts their mean; `crossing` are parameters that may well be nothing: their
    standard error is no share of the value; `conventions` are what runs may leave open. `search` are the options of its
    genetic search that differ from the usual ones, `figures` those that it has, every figure of test runs where there
    are none. `force_scale` is the size of its forces in the words of a scale, `drive_scale` that of its drive signal,
    the motion times the gain where none is stated; with `relative_ways` lengths of effects' shapes are measured by its
    motion. `of_drive` are parameters in whose unit a metre is one of the drive signal; it is shown as `drive_unit`, the
    command's in open loop. `turns`: the motion of such a machine is an angle as a rule; `recorded`
    are the units of the records, `static_gains` parameters that lead from command to output, in the output's unit over
    the command's. `compares` is the channel that its controller does, nothing without one; `gains` are gains of it that
    are known, Kp that of runs that state none. Multiplied or divided by one factor, the parameters `share_force` change
    nothing as long as no force is known: the first is then held by convention. `shown` are the two whose search is
    drawn. `middle` is that of the stroke, m, about which effects act.

    Raises Unusable where an equation or a scale reads what no stage brings and no condition is, where scales read each
    other in a circle, where two stages mean different parameters by one name, and where something is stated of a
    parameter that no stage brings.
    """

    name: str
    title: str
    citation: str
    chain: Chain
    stated: tuple[Parameter, ...] = ()
    rescaled: tuple[Scale, ...] = ()
    rescaled_by_position: tuple[Scale, ...] = ()
    listed: tuple[str, ...] = ()
    searched: tuple[str, ...] = ()
    bounds_hold_for: float | None = None
    without_area: Mapping[str, tuple[str, str]] | None = None
    combinations: tuple[Combined, ...] = ()
    notes: tuple[str, ...] = ()
    driven_by: str = "command"
    under_control: Preset | None = None
    opened: Preset | None = None
    alone: bool = False
    needs: tuple[str, ...] = ()
    steps: int = 1
    absolute: tuple[str, ...] = ()
    crossing: tuple[str, ...] = ()
    conventions: tuple[Convention, ...] = ()
    kind: Kind = "chain"
    methods: tuple[str, ...] = ()
    search: Mapping[str, float] = field(default_factory=dict)
    figures: tuple[str, ...] = ()
    force_scale: str = ""
    relative_ways: bool = False
    drive_scale: str = ""
    of_drive: tuple[str, ...] = ()
    drive_unit: str = "m"
    turns: bool = False
    recorded: RecordUnits = field(default_factory=RecordUnits)
    static_gains: tuple[str, ...] = ()
    compares: str = ""
    gains: Mapping[str, float] = field(default_factory=dict)
    share_force: tuple[str, ...] = ()
    shown: tuple[str, ...] = ()
    middle: float = 0.0

    def __post_init__(self) -> None:
        where, brought = f"preset {self.name}", {p for stage in self.chain.stages for p in stage.parameters}
        own = [parameter.name for parameter in brought]
        if twice := {name for name in own if own.count(name) > 1}:
            raise Unusable("bad-preset", f"its stages mean different parameters by {', '.join(sorted(twice))}", where,
                           "rename one of them")  # fmt: skip
        stated = {
            *self.listed,
            *self.searched,
            *(p.name for p in self.stated),
            *(s.name for s in (*self.rescaled, *self.rescaled_by_position)),
        }
        if idle := stated - set(own):
            raise Unusable("bad-preset", f"no stage brings {', '.join(sorted(idle))}, which it states", where,
                           "leave it out, or let a stage bring it")  # fmt: skip
        known = {parameter.in_equations for parameter in self.parameters} | CONDITIONS.keys() | set(READABLE)
        if unknown := set(self.chain.symbols) - known:
            readers = ", ".join(stage.place for stage in self.chain.stages if stage.reads & unknown)
            raise Unusable("bad-preset", f"no stage brings {', '.join(sorted(unknown))}, read at {readers}",
                           where, "let a stage bring it as a parameter or publish it")  # fmt: skip
        for scale in (*self.scales, *self.rescaled_by_position):
            if strange := scale.equation.names - known - OF_THE_RUNS:
                raise Unusable("bad-preset", f"no stage brings {', '.join(sorted(strange))}, read by a scale",
                               f"{where}, scale of {scale.name}", "measure it by something else")  # fmt: skip

    @property
    def effects(self) -> tuple[Effect, ...]:
        """The effects added to its chain."""
        return self.chain.effects

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        """The parameters of its stages, as stated where they are, and of its effects."""
        of_stages = {parameter.name: parameter for stage in self.chain.stages for parameter in stage.parameters}
        stated = {parameter.name: parameter for parameter in self.stated}
        of_effects = {parameter.name: parameter for effect in self.effects for parameter in effect.added}
        return _in_order(of_stages | stated | of_effects, (*self.listed, *stated))

    @cached_property
    def scales(self) -> tuple[Scale, ...]:
        """How its parameters are searched for a machine of unknown size, in the order of the search."""
        return self._scales(())

    @property
    def scales_by_position(self) -> tuple[Scale, ...]:
        """The same where a position is recorded."""
        return self._scales(self.rescaled_by_position)

    def _scales(self, others: tuple[Scale, ...]) -> tuple[Scale, ...]:
        found = {scale.name: scale for stage in self.chain.stages for scale in stage.scales}
        found |= {scale.name: scale for scale in (*self.rescaled, *others)}
        found |= {p.in_equations: scale_of(effect, p, self._sizes) for effect in self.effects for p in effect.added}
        return in_reading_order(_in_order(found, (*self.searched, *(p.in_equations for p in self.parameters))))

    @property
    def imposed(self) -> Mapping[str, str]:
        """The states that go with what moves the machine, and the channels that may have recorded them."""
        moved = self.driven_by in MOTIONS and "x" in self.chain.states
        return {"x": "displacement"} if moved else {}

    @property
    def _sizes(self) -> dict[str, str]:
        """Of drive signal, its zones, force and time, in the words of a scale: see :func:`scale_of`."""
        drive = self.drive_scale or "Kp*L"
        widest = "0.9*M" if OPENED_BY_COMMAND in self.chain.stages else f"0.5*{drive}"
        return {"D": drive, "Z": widest, "F": self.force_scale, "T": _TIME}

    def with_effects(self, effects: tuple[Effect, ...]) -> Preset:
        """The model with effects added to its chain; their parameters are called effect__parameter in the equations.

        Raises Unusable where the model has no place for an effect.
        """
        if not effects:
            return self
        added = {parameter.in_equations for effect in effects for parameter in effect.added}
        known = {parameter.in_equations for parameter in self.parameters} | added | CONDITIONS.keys() | set(READABLE)
        chain = self.chain.with_effects(tuple(about(effect, self.middle) for effect in effects))
        if set(chain.symbols) - known:
            raise unfit(next(e for e in effects if set(self.chain.with_effects((e,)).symbols) - known))
        return replace(self, chain=chain)

    def takes(self, effect: Effect) -> bool:
        """Whether the model has a place for an effect and no circle of signals with it."""
        try:
            _ = self.with_effects((effect,)).chain.signals
        except Unusable:
            return False
        return True

    def for_matrix(self, matrix: Matrix, load: str = "none") -> tuple[Preset, Matrix]:
        """The model that suits a matrix, and the matrix with what drives that model as its command.

        With `load` "force" no disturbance may be measured beside the force. The data are as they were recorded:
        :func:`ident.preprocessing.prepare` goes on from here. Raises Unusable where the model does not suit them.
        """
        preset = self._driven_as(matrix)
        refuse_unmeasured(preset.chain.symbols, matrix.runs)
        refuse_unstated(preset.needs, matrix)
        if matrix.controller is not None and self.under_control is not None:
            preset = self.under_control.with_effects(self.effects)
        if "Kp" in preset.gains:
            known = preset.gains["Kp"]
            stated = (run if run.gain is not None else replace(run, gain=known) for run in matrix.runs)
            matrix = replace(matrix, runs=tuple(stated))
        if preset.driven_by != "command":
            matrix = replace(matrix, runs=tuple(run.driven_by(preset.driven_by) for run in matrix.runs))
        elif OPENED_BY_COMMAND in preset.chain.stages and matrix.runs:
            preset = replace(preset, drive_unit=matrix.runs[0].units.get("command", "m"))
        preset = replace(preset, recorded=RecordUnits.of(matrix.runs))
        if preset.force_scale and {run.output for run in matrix.runs} == {"load_pressure"}:
            preset = replace(preset, force_scale="A*X")  # its forces are measured
        if "displacement" in preset.chain.outputs and any(run.output not in MOTIONS for run in matrix.runs):
            preset = replace(preset, share_force=())  # a force or a pressure is known beside the motion
        preset = preset.disturbed_as(matrix, load)
        if preset.kind == "chain":
            preset = replace(preset, chain=varying(preset.chain, matrix.runs))
        return preset, matrix

    def _driven_as(self, matrix: Matrix) -> Preset:
        """The machine in open loop where the command is no way. Raises Unusable where runs differ in that."""
        loops = {run.units.get("command") in _WAYS for run in matrix.runs if "command" in run.channels}
        if self.opened is None or loops <= {True}:
            return self
        if len(loops) > 1:
            raise Unusable("bad-command", "runs with a command in m and others in V", "command",
                           "fit the open and the closed loop one after the other")  # fmt: skip
        return self.opened.with_effects(self.effects)

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

    def with_measured_load(self, matrix: Matrix) -> Preset:
        """The model with the force measured on the specimen in place of the specimen's equation."""
        bare = [run.id for run in matrix.runs if "force" not in run.channels]
        if bare:
            raise Unusable("missing-channel", "no force channel", f"run {bare[0]}", "fit without the measured load")
        self.refuse_without_specimen()
        stages = tuple(MEASURED_LOAD if stage is MASS_SPRING_DAMPER else stage for stage in self.chain.stages)
        return replace(self, chain=replace(self.chain, stages=stages))

    def unit(self, parameter: Parameter) -> str:
        """The unit of a parameter as it is shown: a metre of the drive signal is a unit of the command in open loop.

        Where an angle was recorded a length, a force and a mass are an angle, a torque, an inertia; of an unknown
        period a second is a sample, and what was recorded in counts has no metre.
        """
        of_effect = next((effect for effect in self.effects if effect.name == parameter.of), None)
        at_drive = of_effect.place in ("controller", "valve", "spool") if of_effect else parameter.name in self.of_drive
        if parameter.name in self.static_gains:
            return self.recorded.gain
        drive = self.drive_unit if at_drive and OPENED_BY_COMMAND in self.chain.stages else None
        return self.recorded.shown(parameter.unit, drive)

    def refuse_without_specimen(self) -> None:
        """Raise Unusable where the model has no specimen whose force could be measured instead."""
        if MASS_SPRING_DAMPER not in self.chain.stages:
            raise Unusable("unknown-load", f"model {self.name} has no specimen", "load", "use none")

    @property
    def is_linear(self) -> bool:
        """Whether the command alone drives a linear chain: each run is then reduced once (:mod:`ident.fit.reduction`).

        With effects a chain counts as nonlinear even where its equations are linear: at strength zero some have a
        state that nothing reads, or a time constant of nothing.
        """
        return not self.effects and self.chain.is_linear

    @cached_property
    def core(self) -> Chain:
        """The chain without effects."""
        return self.chain.with_effects(())

    @property
    def equations(self) -> tuple[Equation, ...]:
        """Every equation of the model, in the order of the chain."""
        return self.chain.equations

    @property
    def _called(self) -> tuple[str, ...]:
        """What a parameter is found by: its name, that without an area, that of an effect for its strength."""
        without = (name for name, _ in (self.without_area or {}).values())
        return (*(p.name for p in self.parameters), *without, *(effect.name for effect in self.effects))

    def parameter(self, name: str) -> Parameter:
        """The parameter called `name`, also under its name without area, or an effect's by its name alone.

        Raises Unusable with the nearest name.
        """
        for parameter in self.parameters:
            alias = (self.without_area or {}).get(parameter.name, ("", ""))[0]
            if name in (parameter.name, parameter.in_equations, alias):
                return parameter
        for effect in self.effects:
            for parameter in effect.parameters:
                if name == f"{effect.name}.{parameter.symbol}" or (
                    name == effect.name and parameter == effect.strength
                ):
                    return self.parameter(f"{effect.name}.{parameter.name}")
        if self.under_control is not None:
            return self.under_control.with_effects(self.effects).parameter(name)
        raise Unusable(
            "unknown-parameter",
            f"model {self.name} has no parameter {name!r}",
            "bounds or values",
            did_you_mean(name, self._called),
        )


_WAYS = ("m", "rad")


def _in_order(found: Mapping[str, T], first: Iterable[str]) -> tuple[T, ...]:
    """What was found, by these names first."""
    return tuple(found[name] for name in dict.fromkeys((*first, *found)))


_TIME = "max(1/W, H/6)"  # a step may be late by half the time that it is held
