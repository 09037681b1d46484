"""Arguments of the form NAME=…, read into what the library takes."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence

from ident.errors import Unusable


def split(text: str, option: str, form: str) -> tuple[str, str]:
    """`NAME=…` as name and text; raises Unusable that shows the `form` of the option."""
    name, separator, value = (part.strip() for part in text.partition("="))
    if not (name and separator and value):
        raise Unusable("bad-option", f"cannot read {text!r}", option, f"write {option} {form}")
    return name, value


def number(text: str, option: str, form: str) -> float:
    """A plain finite number; raises Unusable that shows the `form` of the option."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise Unusable("bad-number", f"{text!r} is not a number", option, f"write {option} {form}")
    return value


def bounds(texts: Sequence[str], model: str, effects: Sequence[str] = ()) -> dict[str, tuple[float, float]]:
    """`NAME=LO:HI` as SI bounds; both sides may carry a unit, else they are SI."""
    found = {}
    for text in texts:
        name, value = split(text, "--bounds", "NAME=LO:HI")
        lower, separator, upper = value.partition(":")
        if not separator:
            raise Unusable("bad-option", f"cannot read {text!r}", "--bounds", "write --bounds NAME=LO:HI")
        where = f"--bounds {name}"
        found[name] = (in_si(lower, name, model, where, effects), in_si(upper, name, model, where, effects))
    return found


def values(texts: Sequence[str], model: str, effects: Sequence[str] = ()) -> dict[str, float]:
    """`NAME=VALUE` as SI values; a value may carry a unit, else it is SI."""
    pairs = [split(text, "--set", "NAME=VALUE") for text in texts]
    return {name: in_si(value, name, model, f"--set {name}", effects) for name, value in pairs}


def in_si(text: str, name: str, model: str, where: str, effects: Sequence[str] = ()) -> float:
    """A value of the model's parameter `name` in SI; the printed unit of Z0 is converted with a notice."""
    from ident.presets import preset
    from ident.quantity import parameter_value, printed_notice

    if notice := printed_notice(text):
        print(f"notice: {notice}", file=sys.stderr)
    return parameter_value(text, preset(model, effects).parameter(name).unit, where)


def method_options(texts: Sequence[str]) -> dict[str, float]:
    """`NAME=VALUE` as the settings of a method, plain numbers."""
    pairs = [split(text, "--option", "NAME=VALUE") for text in texts]
    return {name: number(value, "--option", "NAME=VALUE") for name, value in pairs}


def effect_values(texts: Sequence[str], model: str) -> dict[str, float]:
    """`NAME[.PARAM=VALUE]` as the parameters of effects, SI; a name alone is a fifth of its largest strength.

    Raises Unusable for an effect or parameter that is not known.
    """
    from ident.presets import preset

    found = {}
    for text in texts:
        name, equals, value = text.partition("=")
        effect = name.partition(".")[0]
        parameter = preset(model, (effect,)).parameter(name)
        found[name] = in_si(value, name, model, f"--effect {name}", (effect,)) if equals else parameter.upper / 5
    return found
