"""Arguments of the form NAME=…, read into what the library takes."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ident.errors import Unusable

if TYPE_CHECKING:
    from ident.custom.definition import Definition
    from ident.diagnosis.named import Named
    from ident.diagnosis.result import Diagnosis
    from ident.presets import Preset


def split(text: str, option: str, form: str) -> tuple[str, str]:
    """`NAME=…` as name and text; raises Unusable that shows the `form` of the option."""
    name, separator, value = (part.strip() for part in text.partition("="))
    if not (name and separator and value):
        raise Unusable("bad-option", f"cannot read {text!r}", option, f"write {option} {form}")
    return name, value


def number(text: str, option: str, form: str) -> float:
    """A plain finite number, with a decimal comma too; raises Unusable that shows the `form` of the option."""
    from ident.units.decimal_sign import with_point

    try:
        value = float(with_point(text, option))
    except Unusable:
        raise
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise Unusable("bad-number", f"{text!r} is not a number", option, f"write {option} {form}")
    return value


def bounds(texts: Sequence[str], model: Preset) -> dict[str, tuple[float, float]]:
    """`NAME=LO:HI` as SI bounds; both sides may carry a unit, else they are SI."""
    found = {}
    for text in texts:
        name, value = split(text, "--bounds", "NAME=LO:HI")
        lower, separator, upper = value.partition(":")
        if not separator:
            raise Unusable("bad-option", f"cannot read {text!r}", "--bounds", "write --bounds NAME=LO:HI")
        where = f"--bounds {name}"
        found[name] = (in_si(lower, name, model, where), in_si(upper, name, model, where))
    return found


def values(texts: Sequence[str], model: Preset) -> dict[str, float]:
    """`NAME=VALUE` as SI values; a value may carry a unit, else it is SI."""
    pairs = [split(text, "--set", "NAME=VALUE") for text in texts]
    return {name: in_si(value, name, model, f"--set {name}") for name, value in pairs}


def names_of(texts: Sequence[str]) -> list[str]:
    """The NAME of each `NAME=…`."""
    return [text.partition("=")[0].strip() for text in texts]


def in_si(text: str, name: str, model: Preset, where: str) -> float:
    """A value of the model's parameter `name` in SI; the printed unit of Z0 is converted with a notice."""
    from ident.presets import angles
    from ident.units.quantity import printed_notice

    if notice := printed_notice(text):
        print(f"notice: {notice}", file=sys.stderr)
    return angles.in_si(text, model.parameter(name).unit, where)


def definitions(files: Sequence[Path]) -> tuple[Definition, ...]:
    """The definitions of own effects in these files: see :func:`additions`."""
    return additions(files)[0].custom


def additions(files: Sequence[Path], terms: int | None = None) -> tuple[Named, Diagnosis | None]:
    """What is defined in these files, each effect called like its file where that gives no name; the last diagnosis.

    Of a diagnosis, as JSON, the terms that it proposes, or the first `terms` of them, with the effects that they stand
    in addition to. A name without a file is that of a kept effect. Raises Unusable with the file at fault.
    """
    from ident.custom.definition import read_effect
    from ident.diagnosis.named import Named

    if terms is not None and not any(file.exists() and is_diagnosis(file) for file in files):
        raise Unusable("bad-option", "no diagnosis that proposes terms", "--terms", "give one as --custom D.json")
    effects: list[str] = []
    custom: list[Definition] = []
    found = None
    for file in files:
        defined, diagnosis = _defined(file, terms)
        for definition in defined.custom:
            try:
                read_effect(definition)
            except Unusable as error:
                raise Unusable(error.code, error.what, f"{file} {error.where}", error.remedy) from None
        effects += defined.effects
        custom += defined.custom
        found = diagnosis or found
    return Named(tuple(dict.fromkeys(effects)), tuple(custom)), found


def _defined(file: Path, terms: int | None) -> tuple[Named, Diagnosis | None]:
    """What a file defines: one effect, or, a diagnosis, what that proposes; what is kept under a name."""
    from app.cli.input_files import read_diagnosis
    from app.cli.local_effects import find
    from ident.custom.definition import definition_of, is_name
    from ident.diagnosis.named import Named, named, of_fit

    if is_name(str(file)) and not file.exists():
        return Named(custom=(dict(find(str(file)).definition),)), None
    if not is_diagnosis(file):
        return Named(custom=(definition_of(file.read_bytes(), file.stem),)), None
    found = read_diagnosis(file)
    proposals = found.proposals
    if not proposals:
        raise Unusable("not-an-effect", "the diagnosis proposes no term", str(file), "its notes say why")
    if terms is not None and not 1 <= terms <= len(proposals):
        raise Unusable("bad-option", f"{terms} of {len(proposals)}", "--terms", f"give 1 to {len(proposals)}")
    there, last = of_fit(found), named(found, str(proposals[:terms][-1].effect["name"])) or Named()
    return Named((*there.effects, *last.effects), (*there.custom, *last.custom)), found


def is_diagnosis(file: Path) -> bool:
    """Whether a file holds a diagnosis, as JSON, and no effect."""
    return file.suffix == ".json" and b'"candidates"' in file.read_bytes()


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
        with_effect = preset(model, (effect,))
        upper = with_effect.parameter(name).upper
        found[name] = in_si(value, name, with_effect, f"--effect {name}") if equals else upper / 5
    return found
