"""Which effects a diagnosis looks for: those that the machine may have and its records could show."""

from __future__ import annotations

from collections.abc import Iterable

from ident.chain.channels import unmeasured
from ident.effects.effect import Effect
from ident.effects.needs import shows_oil, turns_round
from ident.matrix import Matrix
from ident.presets import Preset
from ident.presets.stroke_centre import about_stroke_centre
from ident.run import MOTIONS
from ident.words.titles import title

_OF_DRIVE = ("valve", "spool", "flow", "pressure")
"""Places with the names of hydraulic parts, which a lag and an electric drive do not have."""


def offered_effects(
    catalogue: Iterable[Effect], custom: Iterable[Effect], preset: Preset, matrix: Matrix
) -> dict[str, Effect]:
    """The effects of the catalogue and of the user by their names, each about the middle of the stroke."""
    yields, has_places = _has_specimen(preset, matrix), not turns_round(matrix)
    listed = (*(e for e in catalogue if (yields or not e.of_specimen) and (has_places or not e.of_place)), *custom)
    return {
        effect.name: about_stroke_centre(effect, preset.middle)
        for effect in listed
        if preset.takes(effect)
        and not unmeasured(preset.with_effects((effect,)).chain.symbols, matrix.runs)
        and effect.suits(matrix)
        and effect.unless not in preset.core.symbols
    }


def in_words(effect: Effect, preset: Preset, matrix: Matrix) -> str:
    """An effect in words; of one of a part that nobody described also its action and its place."""
    of, runs = matrix.actuator, matrix.runs
    if effect.place == "load":
        described = any(run.specimen for run in runs)
    else:
        described = bool(of.piston_area or of.servo_valve or of.supply_pressure or any(run.gain for run in runs))
    if described or not effect.does:
        return title(effect.name)
    return f"{title(effect.name)} ({effect.does}, at the {place_in_words(effect, preset, matrix)})"


def place_in_words(effect: Effect, preset: Preset, matrix: Matrix) -> str:
    """Where an effect acts: a model without oil has no valve and no spool, where nothing shows that there is oil."""
    without_oil = not preset.chain.has_oil and not shows_oil(matrix.runs, matrix.actuator.states_oil)
    return "drive" if without_oil and effect.place in _OF_DRIVE else effect.place


def _has_specimen(preset: Preset, matrix: Matrix) -> bool:
    """Whether something may yield: what is moved, a stated or a measured specimen, or a spring of the machine's own."""
    yields = preset.data.driven_by in MOTIONS or any(p.name == "k0" for p in preset.parameters)
    return yields or any(run.specimen or "force" in run.channels for run in matrix.runs)
