"""Where in the chain a residual may be looked at: a place at which something may be missing, against what it may be of.

A missing part d(t) = φ(s(t)) is thought added to the signal `at`; s is the signal `by`. With `directed`, s counts
positive along that signal; with `relative`, d = φ(s) times that signal, so that φ is a share of it.
"""

from __future__ import annotations

import ast
from dataclasses import dataclass, replace

from ident.chain.chain import FORCE, INPUT, INPUT_RATE, Chain
from ident.effects.effect import Effect
from ident.equations.equation import Equation
from ident.presets import Preset


@dataclass(frozen=True)
class View:
    """One such view, with what its two axes show."""

    name: str
    at: str
    by: str
    missing: str
    against: str
    shows: str
    directed: str = ""
    relative: str = ""

    @property
    def signals(self) -> tuple[str, ...]:
        """The internal signals that it reads."""
        return tuple(dict.fromkeys(name for name in (self.by, self.directed, self.relative) if name))


VIEWS = (
    View(
        "spool",
        "w",
        "w",
        "Missing spool opening",
        "Drive signal at the spool",
        "a dead zone is flat outside and slopes inside, an asymmetry is a V, saturation bends both ends",
    ),
    View(
        "play",
        "w",
        "dq",
        "Missing spool opening",
        "Speed of the drive signal at the spool",
        "play between valve and spool is a step at zero: it lags where the motion turns round",
    ),
    View(
        "friction",
        "R",
        "v",
        "Missing resistance",
        "Piston velocity",
        "dry friction is a step at zero, turbulent damping curves upwards on both sides like v|v|",
    ),
    View(
        "spring",
        "R",
        "x",
        "Missing resistance",
        "Piston position",
        "a straight line is a missing stiffness, a cubic one a hardening spring, a flat middle free play",
    ),
    View(
        "pressure-flow",
        "Q",
        "P",
        "Missing share of the flow",
        "Load pressure along the flow",
        "falls to the right where less flow goes against a load than with it",
        directed="Q",
        relative="Q",
    ),
    View(
        "leakage", "L", "P", "Missing leakage", "Load pressure", "a root of the pressure is leakage through an orifice"
    ),
    View(
        "frame",
        "X",
        "F",
        "Missing displacement",
        "Force on the specimen",
        "a straight line is a frame or transducer mount that gives way",
    ),
    View("tracking", "v", "v", "Missing speed", "Speed", "what a single lag does not follow"),
)
"""What engineers look for, in the order of the signal."""
_SEEN = {
    "w": "spool",
    "Ff": "friction",
    "R": "friction",
    "S": "spring",
    "xk": "spring",
    "xL": "spring",
    "Q": "pressure-flow",
    "L": "leakage",
    "Ke": "leakage",
    "X": "frame",
}
"""By the signal that an effect redefines, the view in which that shows."""


_MISSING = {
    "e": "command",
    "w": "spool opening",
    "Q": "flow",
    "R": "resistance",
    "y_fb": "reading in the loop",
    "y": "reading",
}
_AGAINST = {
    "w": "Drive signal at the spool",
    "Q": "Flow",
    "P": "Load pressure",
    "v": "Piston velocity",
    "x": "Piston position",
    "F": "Force on the specimen",
}


def views(preset: Preset) -> tuple[View, ...]:
    """The views that a model's chain has the signals for."""
    return tuple(view for view in VIEWS if _there(view, preset))


def view_called(name: str, preset: Preset) -> View | None:
    """A view of this model by its name; None where it has none.

    Beside :data:`VIEWS` there is one of whatever may be missing from a signal against any other, "Q(P)", and of its
    share of that signal, "Q(P)/Q".
    """
    whole, _, share = name.partition("/")
    at, _, by = whole.removesuffix(")").partition("(")
    if whole == f"{at}({by})" and share in ("", at) and at in _MISSING and by in _AGAINST:
        missing = f"Missing share of the {_MISSING[at]}" if share else f"Missing {_MISSING[at]}"
        view = View(name, at, by, missing, _AGAINST[by], f"what is missing from {at} along {by}", relative=share)
        return view if _there(view, preset) else None
    return next((view for view in views(preset) if view.name == name), None)


def looked_along(preset: Preset) -> tuple[str, ...]:
    """Every signal of the model that a view reads."""
    there = {equation.target for equation in preset.core.equations}
    along = (name for name in _AGAINST if name in there)
    return tuple(dict.fromkeys((*(name for view in views(preset) for name in view.signals), *along)))


def _there(view: View, preset: Preset) -> bool:
    equations = {equation.target: equation for equation in preset.core.equations}
    where = equations.get(view.at)
    return where is not None and not where.is_rate and set(view.signals) <= equations.keys()


def view_of(effect: Effect, preset: Preset) -> View | None:
    """The view in which an effect of this model shows itself; None where it is no function of one signal.

    What remembers where the spool came from shows against the spool's speed.
    """
    targets = {equation.target for equation in effect.equations}
    name = next((name for signal, name in _SEEN.items() if signal in targets), None)
    if name == "spool" and any(equation.is_memory for equation in effect.equations):
        name = "play"
    return view_called(name or "", preset)


def showing(chain: Chain, signals: tuple[str, ...]) -> Chain:
    """The chain with each of its signals as a channel of its own name too."""
    return replace(chain, outputs={**chain.outputs, **{name: name for name in signals}})


def injected(chain: Chain, at: str) -> Chain:
    """The linear chain without command, its input added to the signal `at` instead."""
    zero = dict.fromkeys((INPUT, INPUT_RATE, FORCE), ast.Constant(0.0))

    def other(equation: Equation) -> Equation:
        bare = equation.with_values(zero)
        return Equation(f"{at} = ({bare.python}) + {INPUT}") if equation.target == at else bare

    stages = tuple(replace(stage, equations=tuple(map(other, stage.equations))) for stage in chain.stages)
    return replace(chain, stages=stages)


def unit(preset: Preset, signal: str, area_known: bool) -> str:
    """A signal's unit as its stage declares it; of an unknown area A = 1 m², pressures are forces and flows speeds."""
    found = preset.chain.units.get(signal, "1")
    return found if area_known else {"Pa": "N", "m^3/s": "m/s"}.get(found, found)
