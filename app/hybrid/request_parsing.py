"""What a request asks of the library: cases, controllers, changes; nothing in it is taken for the path of a file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from app.errors import Failure
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.hybrid.case import BUILT_IN, NAMES, Case
from ident.hybrid.changed_machine import SIZES, Change, model_of
from ident.hybrid.coupled_case import CoupledCase, System, case_of_part
from ident.hybrid.coupled_reading import system_of
from ident.hybrid.ground_motion import GroundMotion, ground_of
from ident.hybrid.peak_problem import Axes, PeakTarget
from ident.presets import preset
from ident.run import Specimen
from ident.units.quantity import parameter_value, shown
from ident.words.nearest import did_you_mean
from schemas.hybrid import GroundRequest, HybridRequest, SpecimenRequest, WhatIfRequest

Request = TypeVar("Request", bound=BaseModel)
LONGEST = 2_000_000
"""Characters of a record of ground motion."""
MOTIONS = ("blwn", "sine")
_NO_RECORD = "0\n0"  # stands for the record of a case that another motion replaces, or that is not run any more
_NEAR = 2 / 45  # of the frequency: the usual tolerance, 2 Hz at 45 Hz
_USUAL_SHARE = 5  # a named effect is on at a fifth of its largest strength


@dataclass(frozen=True)
class AskedCase:
    """A case as a request states it, plain JSON data; `text` is the record of its ground motion, kept apart."""

    case: str | dict[str, Any]
    ground: str | dict[str, Any] | None
    text: str = ""

    def read(self, part: str | None = None) -> Case:
        """The case of one actuator, of several that of a `part`. Raises Unusable with the field at fault."""
        return case_of_part(self.system(), part)

    def system(self) -> System:
        """The case of one actuator or of several. Raises Unusable with the field at fault."""
        of = self._own()
        motion = self._motion(of.ground)
        if motion is None:
            return of
        return of.changed(ground=motion) if isinstance(of, CoupledCase) else replace(of, ground=motion)

    def _motion(self, own: GroundMotion) -> GroundMotion | None:
        """The motion in place of the case's own; None where there is none."""
        if self.ground is None:
            return None
        if isinstance(self.ground, str):
            if self.ground not in MOTIONS:
                remedy = did_you_mean(self.ground, MOTIONS, f"give {' or '.join(MOTIONS)}, or a record as text")
                raise Unusable("bad-ground", f"{shown(self.ground)!r} is not a motion", "ground", remedy)
            return replace(own, kind=self.ground)
        return ground_of(_with(self.ground, self.text), None, own)

    def _own(self) -> System:
        """The case with its own motion."""
        if isinstance(self.case, str):
            if self.case not in BUILT_IN:
                raise Unusable(
                    "no-such-case",
                    f"no case {shown(self.case)!r}",
                    "case",
                    did_you_mean(self.case, BUILT_IN, f"give {NAMES}, or an object"),
                )
            return BUILT_IN[self.case]()
        data, ground = self.case, self.case.get("ground")
        if isinstance(ground, dict):
            data = {**data, "ground": _with(ground, self.text if self.ground is None else "")}
        return system_of(data, None, "own case")


def _with(ground: dict[str, Any], text: str) -> dict[str, Any]:
    """A motion with the text of its record where it has one."""
    return {**ground, "text": text or _NO_RECORD} if "text" in ground else ground


def asked_case(case: str | dict[str, Any], ground: str | GroundRequest | None = None) -> AskedCase:
    """A case and a motion in place of its own, as they are asked for. Raises Unusable for a record that is too long."""
    motion: Any = ground
    if isinstance(ground, GroundRequest):
        motion = ground.model_dump(exclude_none=True)
        if isinstance(ground.band, tuple):
            motion["band"] = list(ground.band)
    own = case.get("ground") if isinstance(case, dict) else None
    texts = [_text(one) for one in (motion, own)]
    if isinstance(case, dict) and isinstance(own, dict) and texts[1] is not None:
        case = {**case, "ground": {**own, "text": ""}}
    if isinstance(motion, dict) and texts[0] is not None:
        motion = {**motion, "text": ""}
    return AskedCase(case, motion, (texts[1] if motion is None else texts[0]) or "")


def _text(ground: object) -> str | None:
    """The record in a motion; None where it has none. Raises Unusable."""
    text = ground.get("text") if isinstance(ground, dict) else None
    if text is not None and not (isinstance(text, str) and 0 < len(text) <= LONGEST):
        raise Unusable(
            "bad-ground",
            "not the text of a record",
            "ground text",
            f"give rows of numbers, at most {LONGEST} characters",
        )
    return text


def effects_of(request: HybridRequest, model: str) -> dict[str, float]:
    """The effects that a simulation switches on, by parameter, SI. Raises Unusable for one that is not known."""
    found = {}
    for name in request.effects:
        parameter = preset(model, (name.partition(".")[0],)).parameter(name)
        found[parameter.name] = parameter.upper / _USUAL_SHARE
    for name, value in request.set.items():
        parameter = preset(model, (name.partition(".")[0],)).parameter(name)
        found[parameter.name] = parameter_value(value, parameter.unit, f"set {name}")
    return found


def change_of(fit: FitResult, request: WhatIfRequest) -> Change:
    """What is to change of the machine of a fit, SI. Raises Unusable."""
    if strange := [name for name in request.fitted if name not in SIZES]:
        raise Unusable("unknown-size", f"no size {shown(strange[0])!r}", "fitted", did_you_mean(strange[0], SIZES))
    model = model_of(fit, request.set)
    units = {name: SIZES.get(name) or model.parameter(name).unit for name in request.set}
    given = {name: parameter_value(value, units[name], f"set {name}") for name, value in request.set.items()}
    return Change(
        sizes={name: value for name, value in given.items() if name in SIZES},
        values={name: value for name, value in given.items() if name not in SIZES},
        specimen=specimen_of(request.specimen),
        known=_sizes(request.fitted),
    )


def _sizes(fitted: Mapping[str, float | str]) -> dict[str, float]:
    return {name: parameter_value(value, SIZES[name], f"fitted {name}") for name, value in fitted.items()}


def specimen_of(given: SpecimenRequest, where: str = "specimen") -> Specimen:
    """A specimen that a request states, SI. Raises Unusable."""
    found = {}
    for name, value in given.model_dump(exclude_none=True).items():
        found[name] = parameter_value(value, name, f"{where} {name}")
        if found[name] < 0:
            raise Unusable("bad-number", f"{shown(value)} is below 0", f"{where} {name}", "give 0 or more")
    return Specimen(**found)


def request_in(text: str, kind: type[Request]) -> Request:
    """The request of a figure: the body of the POST as text. Raises Failure 422."""
    try:
        return kind.model_validate_json(text or "{}")
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(map(str, ("asked", *first["loc"])))
        raise Failure(422, "invalid-request", str(first["msg"]), where, "write the body of the POST") from None


def gains_of(request: WhatIfRequest) -> tuple[float, float] | None:
    """The range of gains that is asked for."""
    gain = request.gain
    return gain if gain is None or isinstance(gain, tuple) else (gain, gain)


def peak_of(request: WhatIfRequest) -> PeakTarget | None:
    """The peak that is asked for. Raises Unusable."""
    if request.peak is None:
        if request.tolerance is not None or request.axes or request.up_to is not None:
            raise Unusable("bad-request", "no peak was given", "peak", "give a frequency with it")
        return None
    frequency = parameter_value(request.peak, "frequency", "peak")
    near, end = request.tolerance, request.up_to
    return PeakTarget(
        frequency,
        _NEAR * frequency if near is None else parameter_value(near, "frequency", "tolerance"),
        axes=tuple(Axes(one.gain, one.lower, one.upper) for one in request.axes),
        up_to=0.0 if end is None else parameter_value(end, "frequency", "up_to"),
    )
