"""The meaning of a term in hydraulics."""

from __future__ import annotations

from collections.abc import Sequence

from ident.diagnosis.discovery.term import Term

_INTERPRETATIONS: dict[tuple[str, str, tuple[str, ...]], str] = {
    ("e", "integral", ("e",)): "the controller integrates its error, too",
    ("e", "rate", ("e",)): "the controller takes the rate of its error, too",
    ("dq", "beyond", ("dq",)): "the spool's speed is limited",
    ("dq", "saturation", ("dq",)): "the spool's speed saturates",
    ("dq", "square", ("dq",)): "the spool's speed saturates",
    ("Q", "size", ("P",)): "leakage in one direction: the leak differs with the sign of the pressure",
    ("Q", "square", ("P",)): "leakage that grows with the square of the pressure",
    ("Q", "root", ("P",)): "leakage through an orifice, as the root of the pressure",
    ("Q", "grows with", ("Q", "P")): "the flow gain grows, or falls, with the pressure",
    ("Q", "turns with", ("P", "Q")): "leakage that follows the direction of the flow",
    ("Q", "after", ("Q",)): "the supply gives way under flow, and recovers",
    ("Q", "product", ("P", "Q")): "less flow against a load than with it",
    ("Q", "size", ("v",)): "areas differ: the cylinder takes more oil in one direction",
    ("Q", "size", ("Q",)): "the flow gain differs between the directions",
    ("R", "sign", ("v",)): "dry friction",
    ("R", "square", ("v",)): "damping that grows with the square of the speed",
    ("R", "cube", ("x",)): "a spring that hardens or softens",
    ("R", "size", ("x",)): "a spring that differs between the sides",
    ("R", "turns with", ("P", "v")): "friction of seals that grows with the pressure",
    ("R", "size along", ("P", "v")): "friction of seals that grows with the pressure",
    ("R", "size along", ("x", "v")): "dry friction that grows away from the middle",
    ("R", "square along", ("x", "v")): "dry friction that grows away from the middle",
    ("Ke", "softer with size", ("P",)): "oil that gets softer, or stiffer, with the load",
    ("Ke", "softer with side", ("P",)): "oil that is softer on one side of the piston",
    ("Ke", "softer with side", ("x",)): "oil volumes that change with the stroke",
    ("Ke", "softer with size", ("x",)): "oil volumes that change away from the middle",
    ("Ke", "softer near rest", ("P",)): "oil that is softer at low load, as with air in it",
    ("y_fb", "cube", ("x",)): "a transducer in the loop that is not linear",
    ("y_fb", "square", ("x",)): "a transducer in the loop that is not linear",
    ("y_fb", "even square", ("x",)): "a transducer in the loop that is not linear",
    ("y_fb", "size", ("x",)): "a transducer in the loop with another gain to one side",
    ("y", "cube", ("x",)): "a transducer that is not linear",
    ("y", "square", ("x",)): "a transducer that is not linear",
    ("y", "even square", ("x",)): "a transducer that is not linear",
    ("y", "drift", ("t",)): "a transducer that drifts",
}
_KINDS = {
    "beyond": "acts beyond a threshold to both sides",
    "above": "acts above a threshold",
    "below": "acts below a threshold",
    "saturation": "saturates",
    "lag": "acts late",
    "late": "acts late",
    "play": "has play",
    "friction at": "dry friction at one part of the way",
    "hill of": "acts at one part of the way",
    "hill": "acts at one part of the way",
    "condition": "changes with a condition of the run, with what was recorded beside it, or with time",
    "friction near rest": "dry friction that differs between rest and motion (Stribeck)",
    "friction with": "dry friction that changes with a condition of the run, what was recorded beside it, or time",
    "recorded": "acts with what was recorded beside the machine",
    "slip": "friction that slips smoothly near rest",
    "slip with": "friction that slips smoothly near rest, and grows with another signal",
    "late slip": "friction that slips smoothly near rest and builds up, and turns, with a delay",
    "late friction": "dry friction that builds up, and turns, with a delay",
    "fading": "comes, or goes, with time as what warms up",
    "fading friction": "dry friction that wears in",
    "resonance": "a part that swings on a spring, moved by what is here",
    "free curve": "a free curve: no formula is known for it yet",
    "yields": "a force that builds up along the way and yields, as that of a seal or a strained part (Dahl)",
    "after": "falls, or grows, after large motions, and recovers",
    "periodic": "comes and goes with time, as the pulses of a pump",
}


def interpretation(terms: Sequence[Term]) -> str:
    """The meaning in words; "" where the term has no known name."""
    places = {term.form for term in terms}
    if places == {("Q", "size", ("v",)), ("R", "turns with", ("P", "v"))}:
        return "the areas of the piston differ between the directions"
    found = [_INTERPRETATIONS.get(term.form) or _KINDS.get(term.kind, "") for term in terms]
    return "; ".join(dict.fromkeys(entry for entry in found if entry))
