"""Whether an effect with strength 0 leaves a model exactly as it is: tried with numbers, before anything is fitted."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.chain.chain import FORCE, INPUT, INPUT_RATE, STEP, Chain
from ident.chain.channels import BESIDE_MEAN
from ident.effects.effect import Effect
from ident.equations.grammar import TIME
from ident.errors import Unusable
from ident.presets import Preset

Array = NDArray[np.float64]
_TRIALS = 64
_SAME = 1e-9  # relative difference that is rounding
_SIZES = {"m": 0.02, "m/s": 0.5, "Pa": 1e7, "N": 5e3}
"""The largest states that are tried, by unit."""
_REMEDY = "let the strength multiply what the effect adds, or use lag(x, strength)"


def refuse_unless_off(effect: Effect, preset: Preset, seed: int = 0) -> None:
    """Raise Unusable where the effect, its strength 0, changes a signal or a rate of the model, or is not finite.

    Both chains are evaluated at the same random states, inputs, times and memories, small ones and large ones.
    """
    rng = np.random.default_rng(seed)
    core, added = preset.core, preset.with_effects((effect,)).chain
    drawn = _drawn(preset, effect, added, rng)
    with np.errstate(all="ignore"):
        try:
            plain, changed = _evaluated(core, drawn), _evaluated(added, drawn)
        except ArithmeticError:
            raise _not_off(effect, "the equation has no value there") from None
    for name, value in plain.items():
        if not np.all(np.isfinite(changed[name])):
            raise _not_off(effect, f"{name} is not finite there")
        if np.any(np.abs(changed[name] - value) > _SAME * np.abs(value)):
            raise _not_off(effect, f"{name} is changed there")


def _not_off(effect: Effect, what: str) -> Unusable:
    return Unusable("not-off", f"not off at {effect.strength.symbol} = 0: {what}", f"effect {effect.name}", _REMEDY)


def _drawn(preset: Preset, effect: Effect, chain: Chain, rng: np.random.Generator) -> dict[str, Any]:
    """Values of everything that the equations read but do not define, and of the states; arrays (trials,)."""

    units = {**chain.units, INPUT: "m", FORCE: "N"}

    def signal(name: str) -> Array:
        return rng.choice((-1, 1), _TRIALS) * _SIZES.get(units.get(name, ""), 1.0) * 10.0 ** rng.uniform(-4, 0, _TRIALS)

    free = (*chain.states, *(f"{name}__old" for name in chain.memories), INPUT, INPUT_RATE, FORCE)
    values: dict[str, Any] = {name: signal(name) for name in free}
    values |= {name: np.exp(rng.uniform(-3, 3, _TRIALS)) for name in chain.symbols}
    values |= {
        rest: rng.uniform(-0.5, 0.5, _TRIALS) * values[mean] for rest, mean in BESIDE_MEAN.items() if mean in values
    }
    values |= {p.name: np.full(_TRIALS, p.value) for p in preset.parameters}
    values |= {p.in_equations: np.full(_TRIALS, p.value) for p in effect.added}
    values |= {TIME: rng.uniform(0, 1e3, _TRIALS), STEP: np.full(_TRIALS, 1e-3)}
    return values | _memories(rng)


def _memories(rng: np.random.Generator) -> dict[str, Any]:
    """What remembers passes its input on where its times are 0, and is anything elsewhere; exp as the kernel has it."""

    def remembered(x: Any, *times: Any) -> Any:
        still = np.all([np.asarray(time) == 0 for time in times], axis=0)
        return np.where(still, x, rng.standard_normal(_TRIALS))

    def exp(x: Any) -> Any:
        return np.exp(np.clip(x, -60.0, 60.0))

    return {"lag": remembered, "lag2": remembered, "delay": remembered, "exp": exp}


def _evaluated(chain: Chain, drawn: Mapping[str, Any]) -> dict[str, Array]:
    """Every signal, and every rate under the name of its state with a prime."""
    known = chain.signals_at(drawn)
    found = {e.target: np.asarray(known[e.target]) for e in chain.signals}
    return found | {f"{e.target}'": np.asarray(e.value(known)) for e in chain.equations if e.is_rate}
