"""What an identified actuator is good for, as it is asked: controllers, hybrid simulations, what-if."""

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field

from schemas.fit import Finite

Short = Annotated[str, Field(max_length=200)]
Value = Finite | Short
"""SI, or a text with its unit."""
Case = Annotated[Short | dict[str, Any], Field(examples=["qian", "benchmark2020"])]
"""`qian`, `benchmark2020` (or `benchmark2020-1` to `-4`), or an object with what the YAML file of a case holds.

No file is read: where its ground is a record, `text` holds it. Where `physical` is a list of parts, each may have a
`fit`, the id of a stored one, and a `controller` as the request has it.
"""


class _Asked(BaseModel):
    model_config = ConfigDict(extra="forbid")


class TargetRequest(_Asked):
    """The open loop that is wanted: coefficients in falling powers of s, and the pole of its roll-off."""

    numerator: list[Finite] = Field(max_length=20)
    denominator: list[Finite] = Field(max_length=20)
    roll_off: Value | None = None
    name: Short | None = None


class SpreadRequest(_Asked):
    """What parameters may be off: a `share` of each (20 % without one) and `shares` of some by name.

    Or as they scatter between the approved sets of a `serial`, or the sets in force of a `batch`, of the fit's model.
    """

    share: Value | None = None
    shares: dict[str, Value] = Field(default_factory=dict, max_length=50)
    serial: Short | None = None
    batch: Short | None = None


class AtRequest(_Asked):
    """The `value` of a condition at which the machine is wanted, with its unit, such as 60 degC.

    `over` is temperature, supply_pressure, oil_age or cycles. Each parameter moves by its law over the approved sets of
    a `serial`, the sets in force of a `batch`, or of the fit's model.
    """

    value: Short
    over: Short = "temperature"
    serial: Short | None = None
    batch: Short | None = None


class BeforeRequest(_Asked):
    """The loop when it was stable: the id of the `fit` of its machine, its `gain` Kp; without one that of the loop."""

    fit: Annotated[str, Field(max_length=64)] | None = None
    gain: Finite | None = None


class EarlierRequest(BeforeRequest):
    """The loop of a case when it was stable: fit and gain, and its `case`; without one that of the request."""

    case: Case | None = None


class ControllerRequest(_Asked):
    """A controller to be designed for a stored fit with the specimen, gain, sample rate and delay of a case.

    `part` names one of a case with several actuators. `structure` is `feedback` or `two-degree`; `target` stands for
    eq. (19) of Qian et al. 2014; `seed` is that of the draws from the fitted covariance, or from the `spread`. `before`
    is the loop when it was stable, by which the cause is found where it no longer is. `at` moves the machine to another
    condition.
    """

    fit: str
    case: Case = "qian"
    part: Short | None = None
    target: TargetRequest | None = None
    structure: str = "feedback"
    seed: int = Field(default=0, ge=0, lt=2**31)
    spread: SpreadRequest | None = None
    at: AtRequest | None = None
    before: EarlierRequest | None = None


class GroundRequest(_Asked):
    """A ground motion in place of the case's own: a record as `text`, `blwn`, or a `sine`.

    A record is rows of numbers in `unit` (of acceleration), `step` apart; a header may stand above. `column` (0 is the
    first) takes one of several columns. `amplitude` is the RMS of `blwn` and the peak of a `sine`.
    """

    kind: str | None = None
    text: str | None = Field(default=None, max_length=2_000_000)
    name: Short | None = None
    unit: Short | None = None
    step: Short | None = None
    scale: Value | None = None
    column: int | None = Field(default=None, ge=0, le=1000)
    band: Short | tuple[Short, Short] | None = None
    frequency: Short | None = None
    amplitude: Short | None = None
    duration: Short | None = None
    seed: int | None = Field(default=None, ge=0, lt=2**31)


class SpecimenRequest(_Asked):
    """What the machine moves: each in SI or with its unit, nothing without it."""

    mass: Value | None = None
    stiffness: Value | None = None
    damping: Value | None = None


class HybridRequest(_Asked):
    """A hybrid simulation of a case on the machine of a stored fit.

    `controller` is `none`, `kalman` or another that has a name, the id of a stored one, or what its `.json` holds.
    `effects` are switched on at a fifth of their largest strength; `set` gives values by NAME or NAME.PARAM, with a
    unit or in SI. An `isolator` on the specimen belongs to the structure, and no controller knows it. With `map` there
    is also the map over the shares of mass and stiffness that are physical, for several actuators over the delays of
    two of them. With a `spread` 100 machines that are drawn from it are simulated, too. `before` is the loop when it
    was stable, by which the cause is found where it no longer is. `at` moves the machine to another condition. Of
    several actuators a `spread` and a condition hold for the machine of each, by the sets of its model, and each has
    an isolator, or the `isolator_part` of that name alone.
    """

    fit: str
    case: Case = "qian"
    controller: Annotated[str, Field(max_length=64)] | dict[str, Any] = "none"
    ground: Short | GroundRequest | None = None
    effects: list[Short] = Field(default_factory=list, max_length=50)
    set: dict[str, Value] = Field(default_factory=dict, max_length=50)
    isolator: SpecimenRequest | None = None
    isolator_part: Short | None = None
    map: bool = False
    spread: SpreadRequest | None = None
    at: AtRequest | None = None
    before: EarlierRequest | None = None


class AxesRequest(_Asked):
    """The range of |G| to keep at a gain with the peak."""

    gain: Finite
    lower: Finite
    upper: Finite


class ChooseRequest(_Asked):
    """What a gain Kp is chosen for: phase_margin (°), gain_margin (dB), bandwidth (Hz), peak (dB), overshoot (%)."""

    quantity: Short
    value: Finite


class WhatIfRequest(_Asked):
    """What is to be changed of the machine of a fit: `set` area, stroke, volume or parameters, in SI or with units.

    `fitted` states sizes of the machine that was fitted which its fit does not hold. `gain` are the gains Kp of the
    responses, one or a range. `peak` (Hz) asks for the smallest change that puts a peak there within `tolerance` (2 Hz
    at 45 Hz and in proportion), inside `axes` up to the frequency `up_to`; that takes some seconds. `before` is the
    loop when it was stable, by which the cause is found where it no longer is. `choose` asks for the gain that
    has a margin, say; responses without `gain` are those at it. With a `spread` the loop at each gain is also judged
    over 100 machines drawn from it. `at` moves the fitted machine to another condition before it is changed.
    """

    set: dict[str, Value] = Field(default_factory=dict, max_length=50)
    fitted: dict[str, Value] = Field(default_factory=dict, max_length=3)
    specimen: SpecimenRequest = Field(default_factory=SpecimenRequest)
    gain: Finite | tuple[Finite, Finite] | None = None
    before: BeforeRequest | None = None
    choose: ChooseRequest | None = None
    spread: SpreadRequest | None = None
    at: AtRequest | None = None
    peak: Value | None = None
    tolerance: Value | None = None
    axes: list[AxesRequest] = Field(default_factory=list, max_length=10)
    up_to: Value | None = None
    seed: int = Field(default=0, ge=0, lt=2**31)


class PositionLoopRequest(_Asked):
    """A position regulator P or PI around a servo-actuator of a bench, in rated currents, and the amplitudes.

    `kp` in 1/m, `ki` in 1/(m·s); `sample_time` and computation `delay` in s, 0 where the regulator is analogue; `limit`
    of its output. `amplitudes` of the current at the play are of the rated current; without them 1.5, 3 and 10 times
    the dead space.
    """

    kp: Value
    ki: Value = 0.0
    sample_time: Value = 0.0
    delay: Value = 0.0
    limit: Value | None = None
    amplitudes: list[Value] = Field(default_factory=list, max_length=10)
