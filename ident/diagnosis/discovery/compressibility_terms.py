"""Terms of the oil's compressibility: softer or stiffer oil by pressure, place and direction.

With Ke P' = Q − L − A v a small change Ke φ of the compressibility takes Ke φ P' off the flow, and shows by it.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.discovery.site import Site
from ident.diagnosis.discovery.term import Shape, Signals, Term
from ident.equations.equation import Equation

Array = NDArray[np.float64]
OIL = "Ke"
"""The signal of the compressibility."""
_OF = (("P", "abs({a})", "size"), ("P", "{a}", "side"), ("x", "{a}", "side"), ("x", "abs({a})", "size"))


def compressibility_terms(site: Site) -> Iterator[Term]:
    """Terms that the compressibility may have in addition to its constant."""
    if OIL not in site.typical or "P" not in site.typical:
        return
    for a, text, kind in _OF:
        if a in site.typical:
            powers = site.unit((OIL, 1), (a, 1))
            yield _softer(text.format(a=a), f"softer with {kind}", (a,), powers, ())
    for share in CRITERIA.terms.thresholds:
        h = Shape("h", float(np.quantile(np.abs(site.typical["P"]), share)), site.units["P"])
        if h.value > 0:
            yield _softer("1 / (1 + (P / h)**2)", "softer near rest", ("P",), site.unit((OIL, 1)), (h,))


def _softer(share: str, kind: str, of: tuple[str, ...], unit: dict[str, float], shapes: tuple[Shape, ...]) -> Term:
    factor = Equation(f"d = {share}")

    def taken(signals: Signals, rate: float) -> Array:
        known = {**signals, **{shape.symbol: shape.value for shape in shapes}}
        return np.asarray(-factor.value(known) * signals[OIL] * np.gradient(signals["P"]) * rate)

    return Term(
        "pressure", OIL, f"{OIL} * ({share})", kind, of, unit, shapes, in_time=True, worked_out=taken, through="Q"
    )
