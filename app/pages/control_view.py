"""A controller that was designed on a fit, as the page shows it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ident.hybrid.interval import Interval
from ident.hybrid.target_loop import QIAN2014_TARGET
from ident.stability.judgement import UNSTABLE, Judgement
from ident.words.number import plain, trimmed
from schemas.hybrid_result import ControllerView

Rows = tuple[tuple[str, str, str], ...]
_NO_LIMIT = "no limit"
_MARGINS = {"gain": "Gain margin", "phase": "Phase margin", "sensitivity_peak": "Sensitivity peak"}


@dataclass(frozen=True)
class Earlier:
    """A stored controller or simulation in a list."""

    id: str
    text: str
    made: str


@dataclass(frozen=True)
class Designed:
    """A controller: what its loop can stand (quantity, value, unit), notes, and the address of its figure."""

    id: str
    case: str
    structure: str
    target: str
    made: str
    rows: Rows
    notes: tuple[str, ...]
    figure: str
    unstable: bool
    stability: tuple[str, ...]


@dataclass(frozen=True)
class ControlView:
    """The section: the controller that is shown, and the others of the same fit."""

    shown: Designed | None
    others: tuple[Earlier, ...] = ()

    @property
    def target_example(self) -> str:
        """What the field for an own target begins with: the one that is built in, written out."""
        target = QIAN2014_TARGET
        return (
            f"numerator: {_list(target.numerator)}\ndenominator: {_list(target.denominator)}\n"
            f"roll_off: {trimmed(target.roll_off)} rad/s\nname: my target\n"
        )


def control_view(stored: Sequence[ControllerView], shown: ControllerView | None) -> ControlView:
    """The section for the controllers of a fit, the newest first."""
    others = (one for one in stored if shown is None or one.id != shown.id)
    return ControlView(
        None if shown is None else _designed(shown),
        tuple(Earlier(one.id, called(one), one.created_at) for one in others),
    )


def called(one: ControllerView) -> str:
    """A controller in a list."""
    return f"{one.design.structure}, {case_called(one.case)}"


def case_called(name: str) -> str:
    """A case by its name, or as one that has none."""
    return name if name.startswith("own ") else f"case {name}"


def _designed(one: ControllerView) -> Designed:
    figure = f"/api/v1/controllers/{one.id}/figures/closed-loop"
    rows = tuple(_rows(one.design.model_dump()))
    return Designed(
        one.id,
        case_called(one.case),
        one.design.structure,
        one.design.target.name,
        one.created_at,
        rows,
        tuple(one.design.notes),
        figure,
        one.design.state == UNSTABLE,
        said_of(one.design.stability),
    )


def said_of(judgement: Judgement | None) -> tuple[str, ...]:
    """The sentences of a judgement of stability, where there is one."""
    return () if judgement is None else tuple(judgement.text)


def _list(numbers: Sequence[float]) -> str:
    return f"[{', '.join(f'{number:g}' for number in numbers)}]"


def _rows(design: Mapping[str, Any]) -> Iterator[tuple[str, str, str]]:
    """What a reader wants to know of a design: quantity, value, unit."""
    found, gamma, order = design["margins"], design["gamma"], design["order"]
    yield "γmin of the target, and with its roll-off", f"{gamma['target']:.3f}, {gamma['min']:.3f}", ""
    yield "Gain margin", _limit(found["gain"]), "dB"
    yield "Phase margin", _limit(found["phase"]), "°"
    yield "Delay margin", _limit(found["delay"], 1e3), "ms"
    yield "Sensitivity peak", f"{found['sensitivity_peak']:.2f}", ""
    yield "Magnitude to 5 Hz, within ±", plain(found["magnitude_5"], 2), "dB"
    yield "Magnitude to 25 Hz, within ±", plain(found["magnitude_25"], 2), "dB"
    yield "Phase to 10 Hz, within ±", plain(found["phase_10"], 2), "°"
    yield "Phase to 25 Hz, within ±", plain(found["phase_25"], 2), "°"
    yield "Largest gain, reference to measured", f"{found['peak']:.1f}", "dB"
    yield "Noise gain, sensor to command, RMS", f"{found['noise_gain']:.0f}", "m/m"
    yield "States after and before reduction", f"{order['reduced']}, {order['full']}", ""
    judged = design.get("robustness")
    if judged is not None:
        of = "nominal" if design["structure"] == "feedback" else "reference"
        yield "Sampled models that stay stable", f"{judged['stable']} of {judged['draws']}", ""
        yield f"and within ± 1 dB, ± 10° of {of} to 25 Hz", f"{judged['within']} of {judged['draws']}", ""
        if judged["margins"]:
            yield "Sampled from", judged["spread"], ""
        for name, one in judged["margins"].items():
            yield f"{_MARGINS[name]} of 90 % of them", Interval(**one).ends, one["unit"].removesuffix("1")


def _limit(value: float | None, factor: float = 1.0) -> str:
    return _NO_LIMIT if value is None else plain(factor * value, 3)
