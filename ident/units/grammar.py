"""The grammar of a unit: names and ``1`` joined by ``*``, ``/`` or a space, with whole powers and brackets.

Between two names ``.``, ``-`` and ``·`` multiply, too: ``N.m``, ``lbf-ft``, ``m.s-1``.
"""

from __future__ import annotations

import re

from ident.units.names import COMPOUNDS, SPELLINGS

Powers = dict[str, float]

TOKEN = re.compile(r"\s*(\*\*|[*/^()·⋅×]|[+-]?[0-9]+|[^\W\d]+(?:_[^\W\d]+)*|[%°″\"][CF]?)")
SIGNS = {"·": "*", "⋅": "*", "×": "*", "**": "^"}
ALIKE = str.maketrans({"−": "-", "‐": "-", "‑": "-", "μ": "µ", "º": "°"})
"""Signs that look like others: minus and hyphens, the Greek letter for the micro sign, the ordinal for the degree."""
RAISED = re.compile(r"[⁺⁻]?[¹²³⁴]")
LOWERED = str.maketrans("⁺⁻¹²³⁴", "+-1234")
BETWEEN = re.compile(r"(?<=[^\W_])[.·⋅×-](?=[^\W\d_]|°)")
"""What multiplies between two names: N.m, lbf-ft, kg.m2.s-1."""
SHORTENED = re.compile(r"(?<=[^\W\d_])\.(?=$|[\s*/])")
"""The full stop of an abbreviation: in., sec./rev."""
ADJACENT = re.compile(r"(?<![^\W\d])([^\W\d]+)(-[1-4]|[234])(?![\w.])")
"""A power written right behind its name: mm2, m/s2, in3, s-1."""
POWER = re.compile(r"[+-]?[0-9]{1,2}")
DEEPEST = 5


def powers_of(unit: str) -> Powers | None:
    """The power of each name: ``N*s/m`` → {N: 1, s: 1, m: -1}, ``cm2`` → {cm: 2}, "1" → {}; None for no unit."""
    tokens = tokens_of(ADJACENT.sub(r"\1^\2", plain(unit)))
    if not tokens:
        return None
    powers, after = product(tokens, 0, DEEPEST)
    return {name: power for name, power in powers.items() if power} if after == len(tokens) else None


def plain(unit: str) -> str:
    """The unit in signs of a keyboard, ``*`` between names; a usual compound as what it means."""
    text = RAISED.sub(lambda found: f"^{found[0].translate(LOWERED)}", unit.translate(ALIKE)).strip()
    text = SHORTENED.sub("", BETWEEN.sub("*", text))
    return COMPOUNDS.get(text.replace(" ", "*"), text)


def tokens_of(text: str) -> list[str]:
    """The text cut into names, numbers and signs; empty where something else stands in it."""
    tokens: list[str] = []
    position = 0
    while position < len(text):
        found = TOKEN.match(text, position)
        if found is None:
            return []
        tokens.append(SIGNS.get(found[1], found[1]))
        position = found.end()
    return tokens


def product(tokens: list[str], at: int, depth: int) -> tuple[Powers, int]:
    """Factors from `at` on, and the index of what follows them; index -1 where a factor is missing."""
    powers, at = factor(tokens, at, depth)
    while 0 < at < len(tokens) and tokens[at] != ")":
        sign = -1.0 if tokens[at] == "/" else 1.0
        more, at = factor(tokens, at + (tokens[at] in ("*", "/")), depth)
        for name, power in more.items():
            powers[name] = powers.get(name, 0.0) + sign * power
    return powers, at


def factor(tokens: list[str], at: int, depth: int) -> tuple[Powers, int]:
    """One name, ``1`` or bracket with its power, and the index of what follows; index -1 where there is none."""
    token = tokens[at] if at < len(tokens) else ""
    powers: Powers = {}
    if token == "(" and depth:
        powers, at = product(tokens, at + 1, depth - 1)
        if not 0 < at < len(tokens):
            return {}, -1
    elif token and (token[0].isalpha() or token[0] in '%°″"'):
        powers[SPELLINGS.get(token, token)] = 1.0
    elif token != "1":
        return {}, -1
    at += 1
    if at < len(tokens) and tokens[at] == "^":
        if at + 1 == len(tokens) or not POWER.fullmatch(tokens[at + 1]):
            return {}, -1
        powers, at = {name: own * int(tokens[at + 1]) for name, own in powers.items()}, at + 2
    return powers, at
