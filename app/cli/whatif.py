"""`servoident whatif`: what a change of size, specimen or parameters would do to an identified machine."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.arguments import in_si, number, split
from app.cli.at_option import At, Over, Sets, moved_to
from app.cli.before_option import EarlierFit, EarlierGain, gain_of
from app.cli.figure_files import write_figures
from app.cli.input_files import read_fit
from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from app.cli.progress import shown
from app.cli.regulator import Amplitudes, OfRegulator, show_margins
from app.cli.rig_option import RigFile, rig_in
from app.cli.spread_option import SpreadGiven, spread_in
from ident.words.nearest import did_you_mean

if TYPE_CHECKING:
    from ident.fit.result import FitResult
    from ident.hybrid.changed_machine import Change
    from ident.hybrid.chosen_gain import GainTarget
    from ident.hybrid.peak_problem import PeakTarget
    from ident.hybrid.what_if import Before
    from ident.run import Specimen

_OF_SPECIMEN = {"mass": "mass", "stiffness": "stiffness", "damping": "damping"}
_PART = "part"
_NEAR = 2 / 45  # of the frequency: the usual tolerance, 2 Hz at 45 Hz


FitPath = Annotated[Path, typer.Argument(metavar="FIT.json", help="File from `servoident fit --json`.")]
Changed = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="Change area, stroke, volume (with unit) or a parameter. Z0 scales with the area, Ka with area × stroke "
        "or with the volume. May be repeated.",
    ),
]
Fitted = Annotated[
    list[str] | None,
    typer.Option(
        metavar="NAME=VALUE", help="Area, stroke or volume of the fitted machine, if the fit does not have it."
    ),
]
OfSpecimen = Annotated[
    str | None,
    typer.Option(metavar="mass=…,stiffness=…,damping=…", help="Specimen, with units. Default: no specimen."),
]
Gains = Annotated[
    str | None, typer.Option(metavar="LO:HI", help="Gains Kp of the responses and the root locus. Default: 1:10.")
]
AtPeak = Annotated[
    str | None,
    typer.Option(metavar="HZ", help="Find the smallest change that gives a peak at this frequency, such as 45 Hz."),
]
Near = Annotated[
    str | None, typer.Option(metavar="HZ", help="Tolerance of the peak. Default: 2 Hz at 45 Hz, in proportion.")
]
InAxes = Annotated[
    list[str] | None,
    typer.Option(metavar="KP=LO:HI", help="Required range of |G| at a gain; may be repeated."),
]
UpTo = Annotated[str | None, typer.Option(metavar="HZ", help="Upper end of the axes. Default: peak plus tolerance.")]
Choose = Annotated[
    str | None,
    typer.Option(
        metavar="QUANTITY=VALUE",
        help="Choose Kp for one quantity: phase_margin=50 (°), gain_margin=6 (dB), bandwidth=8 (Hz), peak=2 (dB) or "
        "overshoot=10 (%).",
    ),
]
Seed = Annotated[int, typer.Option(min=0, max=2**31 - 1, help="Random seed of the search.")]
Json = Annotated[Path | None, typer.Option(metavar="FILE", help="Write the result as JSON; - is stdout.")]
Out = Annotated[Path | None, typer.Option(metavar="DIR", help="Write the figures: svg, png, pdf, json.")]


def whatif(
    fit: FitPath,
    set_: Changed = None,
    fitted: Fitted = None,
    specimen: OfSpecimen = None,
    gain: Gains = None,
    choose: Choose = None,
    at: At = None,
    over: Over = "temperature",
    sets: Sets = None,
    spread: SpreadGiven = None,
    before: EarlierFit = None,
    before_gain: EarlierGain = None,
    peak: AtPeak = None,
    tolerance: Near = None,
    axes: InAxes = None,
    up_to: UpTo = None,
    seed: Seed = 0,
    rig: RigFile = None,
    regulator: OfRegulator = None,
    amplitude: Amplitudes = None,
    json: Json = None,
    out: Out = None,
) -> None:
    """Predict the response after a change of the machine.

    Area, stroke, volume, specimen or parameters can change. It gives response, peaks, root locus and stability. Exit
    status 1 if the loop is unstable: cause and remedies are listed. With --regulator it gives the margins of a
    position loop around a servo-actuator of a bench, at stated amplitudes.
    """
    from dataclasses import replace

    from app.cli.tables import show
    from ident.hybrid.what_if import what_if
    from ident.stability.judgement import UNSTABLE

    check_target(json)
    result = read_fit(fit)
    if regulator is not None or amplitude:
        show_margins(result, regulator, amplitude or [], json, out)
        return
    moved = moved_to(result, at, over, sets)
    result = moved.fit
    change = _change(result, set_ or [], fitted or [], specimen)
    gains = None if gain is None else _range(gain, "--gain", "LO:HI")
    target = _target(peak, tolerance, axes or [], up_to)
    with shown() as report:
        found = what_if(
            result,
            change,
            gains,
            target,
            seed,
            report,
            rig_in(rig),
            _before(before, before_gain),
            _wanted(choose),
            spread_in(spread, result.model),
        )
    found = replace(found, notes=(*moved.text, *found.notes))
    if json is not None:
        write_json(found.to_json(), json)
    if json != STANDARD_OUTPUT:
        show(found.listings())
    if out is not None:
        write_figures(found, out)
    if found.state == UNSTABLE:
        raise typer.Exit(1)


def _wanted(text: str | None) -> GainTarget | None:
    """What a gain is to be chosen for; the value may end in the unit of its quantity. Raises Unusable."""
    from ident.hybrid.chosen_gain import GainTarget
    from ident.hybrid.loop_figures import QUANTITIES

    if text is None:
        return None
    name, value = split(text, "--choose", "QUANTITY=VALUE")
    return GainTarget(name, number(value.removesuffix(QUANTITIES.get(name, "")), "--choose", "QUANTITY=VALUE"))


def _before(fit: Path | None, gain: str | None) -> Before | None:
    """The loop when it was stable; None where nothing is said of it."""
    from ident.hybrid.what_if import Before

    if fit is None and gain is None:
        return None
    return Before(None if fit is None else read_fit(fit), gain_of(gain))


def _change(fit: FitResult, set_: list[str], fitted: list[str], specimen: str | None) -> Change:
    """What is to change, SI. Raises Unusable."""
    from ident.errors import Unusable
    from ident.hybrid.changed_machine import SIZES, Change, model_of
    from ident.units.quantity import quantity

    pairs = [split(text, "--set", "NAME=VALUE") for text in set_]
    known = [split(text, "--fitted", "NAME=VALUE") for text in fitted]
    if strange := [name for name, _ in known if name not in SIZES]:
        raise Unusable("unknown-size", f"no size {strange[0]!r}", "--fitted", did_you_mean(strange[0], SIZES))
    model = model_of(fit, [name for name, _ in pairs])
    return Change(
        sizes={name: quantity(value, SIZES[name], f"--set {name}") for name, value in pairs if name in SIZES},
        values={name: in_si(value, name, model, f"--set {name}") for name, value in pairs if name not in SIZES},
        specimen=specimen_of(specimen),
        known={name: quantity(value, SIZES[name], f"--fitted {name}") for name, value in known},
    )


def specimen_of(text: str | None, option: str = "--specimen") -> Specimen:
    """A specimen from `mass=2.06 kg, stiffness=30.65 kN/m`, the value of an `option`. Raises Unusable."""
    return _specimen(_stated(text, option), option, tuple(_OF_SPECIMEN))


def isolator_of(text: str) -> tuple[Specimen, str | None]:
    """An isolator from `stiffness=1 MN/m, part=left`, and the part that has it; None for all. Raises Unusable."""
    option = "--isolator"
    stated = _stated(text, option)
    part = next((value.strip() for name, value in stated if name == _PART), None)
    return _specimen([one for one in stated if one[0] != _PART], option, (*_OF_SPECIMEN, _PART)), part


def _stated(text: str | None, option: str) -> list[tuple[str, str]]:
    """The names and values of a text such as `mass=2.06 kg, stiffness=30.65 kN/m`. Raises Unusable."""
    parts = re.split(r",(?=\s*\w+\s*=)", text or "")  # a comma before digits is a decimal sign
    return [split(part, option, "mass=…,stiffness=…,damping=…") for part in parts if part.strip()]


def _specimen(stated: Sequence[tuple[str, str]], option: str, names: Sequence[str]) -> Specimen:
    from ident.errors import Unusable
    from ident.run import Specimen
    from ident.units.quantity import quantity

    found = {}
    for name, value in stated:
        if name not in _OF_SPECIMEN:
            raise Unusable("bad-option", f"a specimen has no {name!r}", option, did_you_mean(name, names))
        found[name] = quantity(value, _OF_SPECIMEN[name], f"{option} {name}")
        if found[name] < 0:
            raise Unusable("bad-number", f"{value} is below 0", f"{option} {name}", "give 0 or more")
    return Specimen(**found)


def _target(peak: str | None, tolerance: str | None, axes: list[str], up_to: str | None) -> PeakTarget | None:
    """The peak that is asked for. Raises Unusable."""
    from ident.errors import Unusable
    from ident.hybrid.peak_problem import Axes, PeakTarget
    from ident.units.quantity import quantity

    if peak is None:
        if tolerance or axes or up_to:
            raise Unusable("bad-option", "no peak was given", "--peak", "write --peak '45 Hz' with it")
        return None
    frequency = quantity(peak, "frequency", "--peak")
    near = _NEAR * frequency if tolerance is None else quantity(tolerance, "frequency", "--tolerance")
    end = 0.0 if up_to is None else quantity(up_to, "frequency", "--up-to")
    pairs = [split(text, "--axes", "KP=LO:HI") for text in axes]
    kept = tuple(Axes(number(kp, "--axes", "KP=LO:HI"), *_range(ends, "--axes", "KP=LO:HI")) for kp, ends in pairs)
    return PeakTarget(frequency, near, axes=kept, up_to=end)


def _range(text: str, option: str, form: str) -> tuple[float, float]:
    """`LO:HI` as numbers; one number is both."""
    lower, separator, upper = text.partition(":")
    return number(lower, option, form), number(upper if separator else lower, option, form)
