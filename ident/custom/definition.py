"""A user's own effect: a small file of text to an :class:`ident.effects.effect.Effect`, or a refusal that says where.

    name: overlap                                                    (default: the file's name)
    place: spool
    equation: w = w - clip(w, -h, h)                                 one line, or a list of lines
    strength: {symbol: h, unit: mm, lower: 0, upper: 1}              the effect is off at 0
    shape: {T: {unit: ms, lower: 1, upper: 100, value: 20}}          optional: other parameters
    curve: {symbol: h, of: P, knots: [0 MPa, 5 MPa], …}              optional: see ident.custom.curves
    state: {symbol: z, rate: (Q - z) / T, initial: 0}                optional: one state of its own
    meaning: the lands overlap

Numbers are in the entry's `unit` unless they carry one; a shape may be a value alone (``T: 20 ms``). A line without
``NAME =`` redefines the signal that its place hands on. The text passes the checked grammar and nothing else: no
evaluator sees it as it came.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any

from ident.custom.curves import curve_of
from ident.custom.names import Line, check_names
from ident.custom.off_at_zero import refuse_unless_off
from ident.custom.parameters import shapes_of, strength_of, symbol_of
from ident.effects import CATALOGUE
from ident.effects.effect import Effect
from ident.equations.equation import Equation
from ident.equations.grammar import parsed, refused
from ident.errors import Unusable
from ident.parameter import Starts
from ident.presets import PRESETS, Preset, preset
from ident.readers.strict_yaml import read_yaml
from ident.readers.typed_fields import Fields
from ident.stages import PLACES
from ident.units.quantity import shown

Definition = Mapping[str, Any]
KEYS = ("name", "place", "equation", "strength", "shape", "curve", "state", "meaning", "looks", "source")
HANDED_ON = {
    "controller": "e",
    "valve": "q",
    "spool": "w",
    "flow": "Q",
    "pressure": "D",
    "load": "R",
    "sensor": "y_fb",
}
"""The signal that a place hands on: what an equation without ``NAME =`` redefines."""
_LARGEST = 1_000_000  # bytes of a file
_LINES = 8
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9]*(_[A-Za-z0-9]+)*")
_LONGEST = 60  # characters of a name
_LEFT = re.compile(r"\s*([A-Za-z]\w*)\s*(:|'|)\s*=(?![=<>])")
_KINKS = re.compile(r"\b(sgn|sign|where|if)\b|[<>]")


def definition_of(source: str | bytes | Definition, name: str = "") -> dict[str, Any]:
    """The definition as plain JSON data, from the text of a file or as it is; `name` is its default name.

    Raises Unusable where it is no mapping, or too long to be a definition.
    """
    if isinstance(source, str | bytes):
        text = source.encode() if isinstance(source, str) else source
        data = read_yaml(text[:_LARGEST], "effect") if len(text) <= _LARGEST else None
    else:
        data = dict(source) if isinstance(source, Mapping) else source
    if not isinstance(data, dict) or not _plain(data):
        raise Unusable("not-an-effect", "not the definition of an effect", "effect", "write place: … and what follows")
    return {"name": re.sub(r"[\s-]+", "_", name), **{key: value for key, value in data.items() if value is not None}}


def _plain(data: Mapping[str, Any]) -> bool:
    try:
        return len(json.dumps(data, default=str)) <= _LARGEST
    except (ValueError, RecursionError):
        return False


def read_effect(source: str | bytes | Definition, name: str = "", model: str = "") -> Effect:
    """The effect of a definition, checked against `model`, or the first model that has what it acts on.

    Raises Unusable with the field and, for equations, the line and character at fault.
    """
    return _read(json.dumps(definition_of(source, name), sort_keys=True, default=str), model)


def preset_with(model: str, effects: Sequence[str] = (), custom: Sequence[Definition] = ()) -> Preset:
    """The preset with these effects, of the catalogue or of the definitions `custom`; raises Unusable."""
    return preset(model, effects, tuple(read_effect(definition, model=model) for definition in custom))


@lru_cache(maxsize=256)
def _read(text: str, model: str) -> Effect:
    fields = Fields(json.loads(text), "effect", KEYS)
    name = _name(fields)
    place = fields.choice("place", PLACES, str(fields.need("place", f"choose from {', '.join(PLACES)}")))
    strength, shapes = strength_of(fields), shapes_of(fields)
    lines = tuple(_lines(fields, place))
    if strength.start is Starts.ALONG_RANGE and _is_time(strength.symbol, lines):
        strength = replace(strength, start=Starts.TIME)
    own = {"strength": strength.symbol, **{f"shape {p.name}": p.symbol for p in shapes}}
    if curve := curve_of(fields):
        lines, shapes = (curve[0], *lines), (*shapes, *curve[1])
        own |= {f"curve value {p.name}": p.symbol for p in curve[1]}
    chosen = check_names(lines, place, own, _models(model))
    effect = Effect(
        name=name,
        place=place,
        meaning=fields.text("meaning", "an effect of the user"),
        strength=strength,
        texts=tuple(line.equation for line in lines),
        shape=shapes,
        units={line.target: chosen.chain.units[line.target] for line in lines if line.target in chosen.chain.units},
        looks=fields.text("looks"),
        source=fields.text("source", "defined by the user"),
        steps=2 if any(_KINKS.search(line.right) for line in lines) else 1,
        own=True,
    )
    refuse_unless_off(effect, chosen)
    return effect


def _is_time(symbol: str, lines: Sequence[Line]) -> bool:
    """Whether a symbol is by itself the time of a lag or a delay."""
    calls = (call for line in lines for call in re.finditer(r"\b(?:lag2?|delay)\(", line.right))
    return any(re.search(rf",\s*{symbol}\s*[,)]", call.string[call.end() :]) for call in calls)


def together(known: Sequence[Definition], more: Sequence[Definition]) -> tuple[Definition, ...]:
    """The definitions of both; raises Unusable where two effects have one name."""
    found = {str(definition["name"]): definition for definition in known}
    for definition in more:
        name = str(definition["name"])
        if found.setdefault(name, definition) != definition:
            raise Unusable("name-taken", f"there are two definitions of {name}", "effect name", "give one another name")
    return tuple(found.values())


def is_name(text: str) -> bool:
    """Whether an effect can be called so."""
    return len(text) <= _LONGEST and _NAME.fullmatch(text) is not None


def _models(model: str) -> tuple[Preset, ...]:
    return (preset(model),) if model else tuple(PRESETS.values())


def _name(fields: Fields) -> str:
    name = fields.text("name")
    if not is_name(name):
        raise Unusable(
            "bad-name",
            f"{shown(name)!r} is not a name of an effect",
            "effect name",
            "give letters, digits and single underscores, a letter first",
        )
    if name in {effect.name for effect in CATALOGUE}:
        raise Unusable("name-taken", f"the effect library has an effect {name}", "effect name", "give it another name")
    return name


def _lines(fields: Fields, place: str) -> Iterator[Line]:
    """The rate of the own state, then the equations: a rate reads signals as they come to the effect."""
    if "state" in fields:
        state = Fields(fields.data["state"], "state", ("symbol", "rate", "initial", "unit", "meaning"))
        if state.number("initial") or 0.0:
            raise Unusable("bad-state", "a state begins at 0", "state initial", "write initial: 0, shift the rate")
        symbol = symbol_of(state, state.need("symbol", "write symbol: z"))
        rate = str(state.need("rate", "write rate: (Q - z) / T"))
        yield _checked(Line("state rate", f"{symbol}'", rate, 0, rate), own=True)
    given = fields.need("equation", "write equation: w = …")
    lines = [str(one) for one in given] if isinstance(given, list) else str(given).splitlines()
    lines = [line for line in lines if line.strip()]
    if not 0 < len(lines) <= _LINES:
        raise Unusable("bad-equation", f"{len(lines)} lines", "equation", f"write 1 to {_LINES} lines")
    for number, line in enumerate(lines, 1):
        where = "equation" if len(lines) == 1 else f"equation, line {number}"
        found = _LEFT.match(line)
        left = found[1] + {":": ":", "'": "'"}.get(found[2], "") if found else HANDED_ON[place]
        first = found.end() if found else 0
        yield _checked(Line(where, left, line[first:], first, line))


def _checked(line: Line, own: bool = False) -> Line:
    """The line, its right-hand side within the grammar. Raises Unusable that names the field and the character."""
    try:
        if line.left.endswith("'") and not own:
            raise refused(len(line.left) - 1, "a rate stands here", "write the own state as state: {symbol, rate}")
        parsed(line.text, line.first, strict=True)
        Equation(line.equation)
    except Unusable as error:
        where = error.where.replace("equation", line.where, 1)
        raise Unusable(error.code, error.what, where, error.remedy) from None
    return line
