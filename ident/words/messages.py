"""The text of every message, by its key: whole sentences, and the parts of a list. See :mod:`ident.words.message`."""

from __future__ import annotations

from collections.abc import Mapping

SUMMARY: Mapping[str, str] = {
    "summary.missing": "Missing: {effects:all}.",
    "summary.missing_and_helping":
        "Missing: {effects:all}. The error also falls with {helping:all}, but something else is probably the cause.",
    "summary.helping": "The error falls with {helping:all}, but something else may be the cause.",
    "summary.contradicted": "Missing: {effects:all}, but validation data contradict it.",
    "summary.stopped": "Nothing was found so far: the search was stopped.",
    "summary.unlisted": "Missing: something that no listed effect explains.",
    "summary.unlisted_probable":
        "Missing: something that no listed effect explains (probability {probability:probability}).",
    "summary.nothing": "Nothing is missing.",
    "summary.nothing_probable": "Nothing is missing (probability {probability:probability}).",
    "summary.error": "The error on {use:data} is {before:error}; the noise floor is {floor:percent}.",
    "summary.error_floor_unknown": "The error on {use:data} is {before:error}; the noise floor is not known.",
    "summary.change":
        "The error on {use:data} goes from {before:error} to {after:error}; the noise floor is {floor:percent}.",
    "summary.change_floor_unknown":
        "The error on {use:data} goes from {before:error} to {after:error}; the noise floor is not known.",
    "next.label": "Next: correct the label of {run:run}, and fit again.",
    "next.time": "Next: search again with more time.",
    "next.compare": "Next: compare the validation runs with and without {effect:title}.",
    "next.distinguish": "Next: record the proposed run, which separates what these data do not.",
    "next.add_and_propose":
        "Next: add {effects:them}, and look at the proposed terms, or record the proposed run.",
    "next.propose": "Next: look at the proposed terms, or record the proposed run.",
    "next.add": "Next: add {effects:them} to the model, and compare the fits.",
    "next.use": "Next: use the model as it is.",
}  # fmt: skip
"""The verdict of a diagnosis in three lines."""

EFFECTS: Mapping[str, str] = {
    "effect": "{names:or}",
    "effect.strength": "{names:or} ({strength:estimate})",
    "effect.probable": "{names:or} (probability {probability:probability})",
    "effect.strength_probable": "{names:or} ({strength:estimate}, probability {probability:probability})",
    "effect.in_place": "{named} in place of {others:titles}",
    "machine": "{machine}",
    "machine.effect": "{machine} with {effect:title}",
    "machine.error": "{machine}, {error:error}",
    "machine.effect_error": "{machine} with {effect:title}, {error:error}",
    "parameter": "{name} ({meaning})",
    "term": "{equation}",
    "term.meaning": "{equation} ({meaning})",
    "change": "from {before:error} to {after:error}",
    "change.verify": "from {before:error} to {after:error} ({verify:error} on validation data)",
    "change.fewer":
        "from {before:error} to {after:error} ({verify:error} on validation data, {fewer:error} without "
        "{without:titles})",
    "change.unstable": "from {before:error} to {after:error} ({runs:unstable})",
    "late.seconds": "{value:.3g} ± {error:.2g} s",
    "late.samples": "{value:.3g} ± {error:.2g} samples",
}  # fmt: skip
"""Members of a list within a sentence."""

VERDICT: Mapping[str, str] = {
    "verdict.stopped":
        "The search was not over: other missing effects, and alternatives to those found, were not examined.",
    "verdict.lacks": "The model lacks {effects:all}: with {effects:them} the error falls {change}.",
    "verdict.partly":
        "On estimation data the error is partly explained by {effects:all}: with {effects:them} it falls {change}.",
    "verdict.unconfirmed": "No effect was confirmed that lowers the error of {before:error}.",
    "verdict.white":
        "Nothing seems to be missing: the residual, {before:error}, is white. The noise floor is not known.",
    "verdict.nothing": "Nothing is missing: the error of {before:error} is measurement noise.",
    "verdict.nothing_probable":
        "Nothing is missing (probability {probability:probability}): the error of {before:error} is measurement noise.",
    "verdict.none": "No effect of the library lowers the error of {before:error} by more than chance.",
    "verdict.bounded":
        "The strength of {effect} ended at the bound of its search. It may be larger, or stand for another effect: "
        "search within wider bounds.",
    "verdict.group": "These data cannot distinguish {group:listed}: their refits differ by less than chance.",
    "verdict.group_unexplained":
        "These data cannot distinguish {group:listed}: their refits differ by less than chance, or than the "
        "unexplained residual.",
    "verdict.two":
        "These data cannot tell which two of these are present: {group:listed}. Their refits differ by less than "
        "chance.",
    "verdict.two_unexplained":
        "These data cannot tell which two of these are present: {group:listed}. Their refits differ by less than "
        "chance, or than the unexplained residual.",
    "verdict.label": "The label of {run:run} looks wrong ({what}): {evidence}.",
    "verdict.unlisted": "Something remains that none of the listed effects explains.",
    "verdict.unlisted_probable":
        "Something remains that none of the listed effects explains (probability {probability:probability}).",
    "verdict.remains": "Part of the error remains unexplained.",
    "verdict.remains_probable":
        "Part of the error remains unexplained (probability {probability:probability}).",
    "verdict.not_repeated":
        "No command was repeated: part of it may be noise in the band of the command, which a repeated run would show.",
    "group": "These data cannot distinguish {group:listed}.",
    "group.two": "These data cannot tell which two of these are present: {group:listed}.",
    "contradicted.rises":
        "With {named} the error on validation data rises from {before:error} to {after:error}: it may stand for "
        "another effect.",
    "contradicted.rises_by":
        "With {named} the error on validation data rises from {before:error} to {after:error}, {deviations:.1f} "
        "standard errors: it may stand for another effect.",
    "contradicted.unstable":
        "With {named} the model is {runs:unstable}; the error on validation data was {before:error}. It may stand for "
        "another effect.",
    "alone.rises":
        "With {equation} but without those after it the error on validation data rises from {before:error} to "
        "{after:error}.",
    "alone.unstable":
        "With {equation} but without those after it the model is {runs:unstable}; the error on validation data was "
        "{before:error}.",
    "alternative.better": "Another model explains more: {models:listed} (--model).",
    "alternative.equal": "These data cannot distinguish it from other models: {models:listed}.",
    "dispensable.one":
        "With the terms that a search proposes beyond the library, {effects:titles} is not needed: it stood for them.",
    "dispensable.several":
        "With the terms that a search proposes beyond the library, {effects:titles} are not needed: they stood for "
        "them.",
    "horizon.runs":
        "These are errors over whole runs, where the fit was made over windows of {fitted:.3g} s: within these, what "
        "is missing adds up to little.",
    "horizon.windows":
        "These are errors over windows of {horizon:.3g} s, where the fit was made over windows of {fitted:.3g} s: "
        "within these, what is missing adds up to little.",
    "delay": "A slow command is answered {time} late. These data cannot tell by which lag or delay: {names:listed}.",
    "delay.before":
        "A slow command is answered {time} late, {before} by the fitted model. These data cannot tell by which lag or "
        "delay: {names:listed}.",
    "delay.without":
        "Without {without:titles} a slow command is answered {time} late. These data cannot tell by which lag or "
        "delay: {names:listed}.",
    "delay.without_before":
        "Without {without:titles} a slow command is answered {time} late, {before} by the fitted model. These data "
        "cannot tell by which lag or delay: {names:listed}.",
    "proposed": "Beyond the library a search proposes: {terms:terms}.",
    "proposed.instead": "Beyond the library a search proposes in place of {instead:titles}: {terms:terms}.",
    "proposed.hypothesis": "This is a hypothesis.",
    "proposed.free_curve": "The last term is a free curve.",
    "proposed.error": "With {terms:them} the error is {error:error}.",
    "proposed.error_verify": "With {terms:them} the error is {error:error} ({verify} on validation data).",
    "proposed.error_unstable": "With {terms:them} the error is {error:error} ({runs:unstable}).",
}  # fmt: skip
"""The verdict of a diagnosis in full."""

WHY: Mapping[str, str] = {
    "why.predicted":
        "Predicted to lower the error by {share:.2g} %, less than others; it was not refitted.",
    "why.change": "On held-out data the error goes from {before:error} to {after:error}.",
    "why.change_floor":
        "On held-out data the error goes from {before:error} to {after:error}, with the noise floor at "
        "{floor:percent}.",
    "why.best": "No other effect does better.",
    "why.little":
        "The effect explains {share:.2g} ± {error:.2g} % of the error above the noise floor. It counts from "
        "{least:.2g} % on, beyond the standard error.",
    "why.half": "The error rises on the {part} of the records: what only part of the data ask for is not added.",
    "why.condition": "The error rises on one condition of the tests: what only part of the data ask for is not added.",
    "why.chance": "That is no more than the best of all effects gains by chance.",
    "why.shows": "It shows as: {looks}.",
    "why.would_show": "It would show as: {looks}.",
}  # fmt: skip
"""Why the data speak for or against an effect."""

CHECKS: Mapping[str, str] = {
    "check.band_narrow":
        "the command of {run:run} is called blwn, but {share:.0%} of its power lies below {edge:.3g} Hz instead of "
        "about 76 Hz; higher frequencies are not excited and not identifiable: check the generator, the sample rate "
        "and kind",
    "check.band_wide":
        "the command of {run:run} is called blwn, but {share:.0%} of its power lies below {edge:.3g} Hz instead of "
        "about 76 Hz; the model is made for 0-80 Hz: check the generator, the sample rate and kind",
    "check.copied":
        "{channel} of {run:run} is a copy of its command, without delay, dynamics or noise, which no sensor gives; "
        "check that its column is that of the sensor",
    "check.clipped_high":
        "{channel} of {run:run} seems clipped: {count} peaks end at its highest value {level:.4g} {unit}; look at the "
        "range of the sensor or amplifier and repeat the run",
    "check.clipped_low":
        "{channel} of {run:run} seems clipped: {count} peaks end at its lowest value {level:.4g} {unit}; look at the "
        "range of the sensor or amplifier and repeat the run",
    "check.flat":
        "{channel} of {run:run} is flat from sample {first} to {last} ({duration:.3g} {unit}) while {other} moves; "
        "look for a stuck sensor or a filled gap and cut it out with rows",
    "check.sign":
        "displacement of {run:run} moves against the command ({turn:.0f} degrees at {low:.2g}-{high:.2g} Hz); set "
        "invert: true on the channel whose sign is wrong",
    "check.unit":
        "displacement of {run:run} is {ratio:.3g} times the command at {low:.2g}-{high:.2g} Hz; correct the unit or "
        "scale of the channel",
    "check.unit_like":
        "displacement of {run:run} is {ratio:.3g} times the command at {low:.2g}-{high:.2g} Hz, near {factor:g}, as if "
        "{unit}; correct the unit or scale of the channel",
    "check.unrelated":
        "displacement of {run:run} hardly follows the command (coherence {coherence:.2f} where it is excited); check "
        "that both columns are the right ones and of this run",
    "check.force_sign":
        "force of {run:run} is {ratio:.2g} times what its specimen needs: the sign is wrong; set invert: true on "
        "force, which is positive on the specimen along +x",
    "check.offset_above":
        "the mean displacement of {run:run} is {millimetres:.3g} mm above the command ({share:percent} of its "
        "standard deviation). The error of eq. (17) ignores constant offsets.",
    "check.offset_below":
        "the mean displacement of {run:run} is {millimetres:.3g} mm below the command ({share:percent} of its "
        "standard deviation). The error of eq. (17) ignores constant offsets.",
    "check.offset_large": "Zero the sensor, or state the offset",
    "check.offset_small": "Possible causes: null bias, static load, sensor zero",
    "check.active":
        "in {run:run} the mean of force times speed is {work:.2f} of their deviations. A passive specimen cannot "
        "produce work, so one of the two has the wrong sign. Set invert: true on it",
    "check.beyond_stroke":
        "displacement of {run:run} travels {extent:.3g} m where the stroke is {stroke:.3g} m; correct the unit of the "
        "channel or the stroke",
    "check.beyond_supply":
        "{channel} of {run:run} reaches {highest:.3g} Pa where the supply is {supply:.3g} Pa; correct the unit of the "
        "channel or supply_pressure",
    "check.gaps":
        "the time of {run:run} has gaps: {missing} samples are missing, and the phase after a gap is shifted. Use the "
        "longest part without a gap (rows), or repeat the run",
    "check.gaps_filled":
        "the time of {run:run} has gaps: {missing} samples are missing, and they were interpolated. Use the longest "
        "part without a gap (rows), or repeat the run",
    "check.jitter":
        "the clock of {run:run} has a jitter of up to {jitter:.2g} samples, and a constant sample rate is assumed. "
        "Record with a hardware clock, or print the time with more digits",
    "check.jitter_held":
        "the clock of {run:run} has a jitter of up to {jitter:.2g} samples. The record was resampled to {rate:.6g} Hz "
        "by its time column, with the steps of the held command at their time",
    "check.jitter_interpolated":
        "the clock of {run:run} has a jitter of up to {jitter:.2g} samples. The record was resampled to {rate:.6g} Hz "
        "by its time column, by interpolation",
    "check.few_samples":
        "{run:run} has {samples:.2g} samples per cycle at {highest:.3g} Hz, and {share:.0%} of the power of the "
        "command is below that. Use at least {least:.3g} Hz",
    "check.too_quick":
        "the sample rate of {run:run} is too low: {share:.0%} of the step response happens within {samples} samples. "
        "Use at least {least:.3g} Hz",
    "check.closed_loop":
        "the command of {run:run} depends on the measured output, so a controller made it: the output predicts "
        "{share:percent} of the innovations of the command. Use the reference of the controller as the command and "
        "state controller or gain, or set closed_loop: false if there is no feedback",
}  # fmt: skip
"""Findings of the data check."""

MESSAGES: Mapping[str, str] = {**SUMMARY, **EFFECTS, **VERDICT, **WHY, **CHECKS}
"""Every text by its key."""
