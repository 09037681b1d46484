"""The text of every message, by its key: whole sentences, and the parts of a list. See :mod:`ident.words.message`."""

from __future__ import annotations

from collections.abc import Mapping

from ident.words.check_messages import CAUSES, CHECKS
from ident.words.verdict_messages import EFFECTS, SEARCH, STRUCTURES, SUMMARY, VERDICT, WHY

DRAFTS: Mapping[str, str] = {
    "draft.missing": "the files do not say: {questions:terms}",
    "draft.command": "replace the words in capitals, and type: {command}",
    "draft.command_whole": "type: {command}",
    "draft.parted":
        "command and output are in different files: join the files of each run first, servoident join A.csv B.csv "
        "--out run.csv, and describe the joined files",
    "draft.say": "say it, as {options:listed}",
    "draft.named": "'{column}' is used as {use}, because of its name",
    "draft.sparse":
        "'{column}' is not used as {use}: it has values in {share:percent} of the rows alone, and a sample needs all "
        "channels",
    "draft.unused": "no channel is taken from {columns}",
    "draft.first_is_time": "column {number} has no name and increases in equal steps, so it is used as time",
    "draft.rate": "the sample rate {rate:g} Hz is from the lines above the table",
    "draft.rate_without_unit":
        "the sample rate {rate:g} Hz is from the lines above the table, which name no unit: Hz is assumed",
    "draft.rate_of_file": "the sample rate {rate:g} Hz is stated in the file",
    "draft.rate_of_variable":
        "the sample rate {rate:g} Hz is from the variable '{variable}', which names no unit: s or Hz is assumed",
    "draft.file": "{file} ({parts:terms})",
    "draft.columns": "{columns}",
    "draft.more": "so are {count} more",
    "draft.no_file": "'{name}' is none of the files",
    "draft.several_files": "'{name}' is more than one of the files",
    "kept.saved": "{name} is saved in {where}",
    "kept.already": "{name} was already saved in {where}",
    "kept.saved_by": "{name} is saved by {where}",
    "kept.already_by": "{name} was already saved by {where}",
    "tidy.removed": "{count} raw uploads that no record names are removed",
    "tidy.found": "{count} raw uploads that no record names; --yes removes them",
}  # fmt: skip
"""Files that are described, and what is kept."""

FIGURES: Mapping[str, str] = {
    "chart.limits": "dashed: 3 σ limits; marked: {marked} out of control",
    "chart.with_limits": "dashed: 3 σ limits, dotted: limits of the product; marked: {marked} out of control",
    "feedforward.gain": "gain {gain:.3g} V/m, {margin:.2g} dB below the stability limit of {limit:.3g} V/m",
    "feedforward.no_limit": "gain {gain:.3g} V/m, stable at any gain",
    "feedforward.error": "error 1/{ratio} of that with feedback alone, median of {draws} draws",
    "rig.stable": "stable",
    "rig.unstable": "unstable",
    "rig.ran_away": "unstable: ran away after {after:quantity}",
    "peak": "a peak at {frequency} ± {tolerance} Hz",
    "peak.inside": "a peak at {frequency} ± {tolerance} Hz inside the axes",
    "poles.left_out": "without what acts by amplitude: {names:listed}",
    "loop.stands":
        "At {amplitude:percent} of the rated current the actuator stands: the amplitude is within its dead space.",
    "loop.no_gain":
        "At {amplitude:percent} of the rated current no gain makes the loop oscillate: gain margin none, phase margin "
        "{phase:degrees}.",
    "loop.margins":
        "At {amplitude:percent} of the rated current the gain margin is {margin:.3g} dB, the phase margin "
        "{phase:degrees}: with kp = {gain:.4g} 1/m the loop oscillates at {frequency:.4g} Hz.",
    "loop.unstable":
        "At {amplitude:percent} of the rated current the loop oscillates: its gain is {excess:.3g} dB too high. It "
        "stops below kp = {gain:.4g} 1/m; with that it oscillates at {frequency:.4g} Hz.",
    "white.pass": "pass (white on {white} of {runs:runs})",
    "white.fail": "fail (white on {white} of {runs:runs})",
    "track.holds": "holds: {reason}",
    "track.fails": "does not hold: {reason}",
    "cpk.few": "{sets:sets}; given from {least} on",
    "sets": "{count}, of model {model}",
    "sets.newest": "{count}, the newest, of model {model}",
    "design.nominal": "and within ± 1 dB, ± 10° to 25 Hz of nominal",
    "design.wanted": "and within ± 1 dB, ± 10° to 25 Hz of wanted",
    "law.few": "The {condition} is stated for {sets:sets}; a law needs {least}.",
    "law.one_condition": "The {condition} of all sets is the same: nothing is known of its influence.",
    "law.holds":
        "Law over the {condition}: {name}, probability {share:percent}. The sets scatter by {scatter} about it.",
    "law.fails":
        "No law over the {condition} holds. The best is {name}; its lack of fit is no chance (p = {p:.2g}).",
    "law.does_not_hold": "{p}, does not hold",
    "law.beyond": "{value} is outside the conditions of the sets, {low} to {high}.",
    "law.none": "The fit has no parameter.",
    "moved.by": "{name} {before:.4g} → {after:.4g} {unit} ({law})",
    "moved.from": "Moved from {here} to {there} by the laws of {sets:sets} of {of}: {what}.",
    "moved.kept": "No law holds for {names:listed}: left as fitted.",
    "limit.absent": "{name}: the set has no such value",
    "limit.silent": "{name}: not judged. {why}",
    "limit.not_judged": "{name} {value}: fixed or not identifiable, so not judged",
    "limit.inside": "{name} {value} is within {limits}",
    "limit.outside": "{name} {value} is outside {limits}",
    "limit.uncertain": "{outcome}, but uncertain: a limit is less than {errors} standard errors away",
    "bulk": "{modulus}.",
    "bulk.std_error": "Its standard error is not known, because that of {name} is not.",
}  # fmt: skip
"""Captions, and what stands with a result."""

MESSAGES: Mapping[str, str] = {
    **SUMMARY, **EFFECTS, **VERDICT, **WHY, **STRUCTURES, **SEARCH, **CHECKS, **CAUSES, **DRAFTS, **FIGURES,
}  # fmt: skip
"""Every text by its key."""
