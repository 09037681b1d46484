"""What the form of a what-if asks, as the request of the service; empty fields are left out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ident.errors import Unusable
from ident.hybrid.changed_machine import SIZES
from ident.units.quantity import parameter_value, quantity
from schemas.hybrid import WhatIfRequest

_SPECIMEN = {name: name for name in ("mass", "stiffness", "damping")}
_PEAK = dict.fromkeys(("peak", "tolerance", "up_to"), "frequency")


def what_if_request(given: Mapping[str, str]) -> WhatIfRequest:
    """The request; raises Unusable for what is no number, or a size, specimen or frequency without its unit."""
    stated = {name: text.strip() for name, text in given.items() if text.strip()}
    gain = _gains(stated)
    request: dict[str, Any] = {
        "set": _quantities(SIZES, stated) | _under("set.", stated),
        "fitted": _quantities(SIZES, _under("fitted.", stated)),
        "specimen": _quantities(_SPECIMEN, stated),
        "gain": gain,
        "before": _before(stated),
        "choose": _chosen(stated),
        "spread": _under("spread.", stated) or None,
        "at": _at(_under("at.", stated)),
        **_quantities(_PEAK, stated),
        "axes": _axes(stated, gain),
    }
    if "seed" in stated:
        request["seed"] = _whole(stated["seed"])
    return WhatIfRequest(**request)


def _quantities(dimensions: Mapping[str, str], stated: Mapping[str, str]) -> dict[str, float]:
    """Those that are stated, SI."""
    return {name: quantity(stated[name], of, name) for name, of in dimensions.items() if name in stated}


def _at(stated: dict[str, str]) -> dict[str, str] | None:
    """The condition of the machine; the name of the condition always stands in the form."""
    if "value" not in stated and len(stated) > ("over" in stated):
        raise Unusable(
            "bad-request", "parameter sets were given, but no condition", "at", "give its value, such as 60 degC"
        )
    return stated if "value" in stated else None


def _under(prefix: str, stated: Mapping[str, str]) -> dict[str, str]:
    return {name.removeprefix(prefix): text for name, text in stated.items() if name.startswith(prefix)}


def _gains(stated: Mapping[str, str]) -> tuple[float, float] | None:
    """Both ends of the range; one that is given alone is both."""
    ends = [stated[name] for name in ("gain_from", "gain_to") if name in stated]
    if not ends:
        return None
    lower, upper = (parameter_value(end, "1", "gain") for end in (ends[0], ends[-1]))
    return lower, upper


def _before(stated: Mapping[str, str]) -> dict[str, float | str] | None:
    """The loop when it was stable."""
    found: dict[str, float | str] = {}
    if "before_gain" in stated:
        found["gain"] = parameter_value(stated["before_gain"], "1", "before_gain")
    if "before_fit" in stated:
        found["fit"] = stated["before_fit"]
    return found or None


def _chosen(stated: Mapping[str, str]) -> dict[str, float | str] | None:
    """What a gain is to be chosen for; the quantity always stands in the form."""
    if "choose_value" not in stated:
        return None
    return {"quantity": stated.get("choose", ""), "value": parameter_value(stated["choose_value"], "1", "choose")}


def _axes(stated: Mapping[str, str], gain: tuple[float, float] | None) -> list[dict[str, float]]:
    """The range of |G| at either end of the gains."""
    found = []
    for place, name in enumerate(("axes_from", "axes_to")):
        if name not in stated:
            continue
        if gain is None:
            raise Unusable("bad-axes", "a range of |G| without a gain", "axes", "give the range of the gain Kp, too")
        lower, colon, upper = stated[name].partition(":")
        if not colon:
            raise Unusable("bad-axes", f"cannot read {stated[name][:40]!r}", "axes", "write the range as 0.5:1")
        ends = (parameter_value(end, "1", "axes") for end in (lower, upper))
        found.append(dict(zip(("gain", "lower", "upper"), (gain[place], *ends), strict=True)))
    return found


def _whole(text: str) -> int:
    if not text.isdecimal() or int(text) >= 2**31:
        raise Unusable("bad-number", f"{text[:40]!r} is not a seed", "seed", "give a whole number from 0")
    return int(text)
