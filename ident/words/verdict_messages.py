"""The texts of a diagnosis by key: its verdict, why an effect or a model was chosen, and what a search says."""

from __future__ import annotations

from collections.abc import Mapping

SUMMARY: Mapping[str, str] = {
    "summary.missing": "Missing: {effects:all}.",
    "summary.missing_partly": "Missing: {effects:all}. Something else is missing, too: part of the error remains.",
    "summary.missing_and_helping":
        "Missing: {effects:all}. The error also falls with {helping:all}, but something else is probably the cause.",
    "summary.helping": "The error falls with {helping:all}, but something else may be the cause.",
    "summary.helping_by_chance":
        "Probably nothing is missing. The error falls with {helping:all}, which may be chance.",
    "summary.contradicted":
        "Not confirmed: {effects:all}. Estimation data support {effects:them}, but validation data contradict "
        "{effects:them}.",
    "summary.contradicted_after":
        "The error falls with {before:all}. Not confirmed: {effects:all}. Estimation data support {effects:them}, but "
        "validation data contradict {effects:them}.",
    "summary.unconfirmed":
        "Not confirmed: {effects:all}. Estimation data support {effects:them}, but validation data show nothing of "
        "{effects:them}.",
    "summary.label": "The label of {run:run} looks wrong: correct it before you conclude what is missing.",
    "summary.stopped": "Nothing was found yet: the search was stopped early.",
    "summary.unexamined": "Nothing was examined: there was no time for it.",
    "summary.unlisted": "Missing: something that no effect in the library explains.",
    "summary.unlisted_probable":
        "Missing: something that no effect in the library explains (probability {probability:probability}).",
    "summary.above_floor":
        "Probably nothing is missing (probability {probability:probability}), though the error is larger than its "
        "noise floor explains.",
    "summary.correlated":
        "Probably nothing is missing (probability {probability:probability}), though the residual is correlated.",
    "summary.validation":
        "No effect is confirmed, but the error on validation data is far above its noise floor: the model lacks "
        "something there, or the machine was different in these runs.",
    "summary.nothing": "Nothing is missing.",
    "summary.nothing_probable": "Nothing is missing (probability {probability:probability}).",
    "summary.missing_input": "Missing: an input that is not in the record of {run:run}.",
    "summary.oscillation": "The machine oscillates by itself: {evidence}.",
    "summary.error": "The error on {use:data} is {before:error}; the noise floor is {floor:percent}.",
    "summary.error_floor_unknown": "The error on {use:data} is {before:error}; the noise floor is not known.",
    "summary.error_unknown": "The error of the model is not known.",
    "summary.change":
        "The error on {use:data} goes from {before:error} to {after:error}; the noise floor is {floor:percent}.",
    "summary.change_floor_unknown":
        "The error on {use:data} goes from {before:error} to {after:error}; the noise floor is not known.",
    "next.label": "Next: correct the label of {run:run} in matrix.yaml, then diagnose again.",
    "next.label_and":
        "Next: correct the label of {run:run} in matrix.yaml, then diagnose again: {effects:titles} may still be "
        "missing.",
    "next.input":
        "Next: record the missing input and add its channel to matrix.yaml, or leave out the rows in which the output "
        "moves by itself (rows in matrix.yaml). Then diagnose again.",
    "next.oscillation": "Next: lower the gain of the loop, or leave {runs:all} out of the fit, and fit again.",
    "next.label_value":
        "Next: correct the {what} of {run:run} in matrix.yaml, then diagnose again. It is stated as "
        "{stated:quantity}; the data say {found:quantity}.",
    "next.label_value_and":
        "Next: correct the {what} of {run:run} in matrix.yaml, then diagnose again: {effects:titles} may still be "
        "missing. The {what} is stated as {stated:quantity}; the data say {found:quantity}.",
    "next.time": "Next: search again with more time (--time, in s).",
    "next.compare":
        "Next: do not add {effect:title} yet. Compare the fit with it and the fit without it on each validation run: "
        "the error rises only on some of them if these are of another machine.",
    "next.more": "Next: search again with up to {most} effects in all (--max-effects {most}).",
    "next.distinguish":
        "Next: record the proposed run, which distinguishes {group:titles}. Then diagnose again.",
    "next.add_and": "Next: add {effects:them}. Then {then:or}.",
    "next.then": "Next: {then:or}.",
    "then.terms": "look at the proposed terms",
    "then.run": "record the proposed run",
    "then.search": "search for unknown terms",
    "next.add": "Next: add {effects:them} to the model, and compare the fits.",
    "next.validation":
        "Next: compare the conditions of the validation runs with those of the estimation runs, or fit the model to "
        "some of them, too.",
    "next.use": "Next: use the model as it is.",
}  # fmt: skip
"""The verdict of a diagnosis in three lines."""

EFFECTS: Mapping[str, str] = {
    "effect": "{names:or}",
    "effect.strength": "{names:or} ({strength:estimate})",
    "effect.probable": "{names:or} (probability {probability:probability})",
    "effect.one_of": "{names:or} (one of them: probability {probability:probability})",
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
        "The search was stopped early: other missing effects, and alternatives to those found, were not examined.",
    "verdict.lacks": "The model lacks {effects:all}: with {effects:them} the error falls {change}.",
    "verdict.lacks_one_of": "The model lacks {effects:all}: with {added:titles} the error falls {change}.",
    "verdict.may_lack":
        "The error falls {change} with {effects:all}. More probably this has another cause, or is chance.",
    "verdict.by_chance":
        "Probably nothing is missing (probability {probability:probability}). The error on estimation data falls "
        "{change} with {effects:all}, but more probably this is chance.",
    "verdict.partly": "With {effects:all} the error on estimation data falls {change}.",
    "verdict.unconfirmed": "No effect was confirmed that lowers the error of {before:error}.",
    "verdict.shows_nothing":
        "With {named} the error on estimation data falls further, but not beyond chance on validation data: it is "
        "{before:error} there without it and {after:error} with it, and would be {due:error} if it acted. Either it "
        "only imitates something else, or the machine was different in these runs.",
    "verdict.changes_more":
        "With {named} the error on estimation data falls further, but not beyond chance on validation data: it is "
        "{before:error} there without it and {after:error} with it, which changes the output by {shown:error}, more "
        "than the whole error. Either it only imitates something else, or the machine was different in these runs.",
    "verdict.white":
        "Nothing seems to be missing: the residual, {before:error}, is white. The noise floor is not known.",
    "verdict.unpredicted":
        "Nothing seems to be missing: the command predicts nothing of the residual, {before:error}.",
    "verdict.unpredicted_probable":
        "Nothing seems to be missing (probability {probability:probability}): the command predicts nothing of the "
        "residual, {before:error}.",
    "verdict.nothing": "Nothing is missing: the error of {before:error} is measurement noise.",
    "verdict.nothing_probable":
        "Nothing is missing (probability {probability:probability}): the error of {before:error} is measurement noise.",
    "verdict.validation":
        "This holds on estimation data. On validation data the error is {error:error}, and noise makes {noise:error} "
        "of it: the machine was different in these runs, or the model lacks something that the estimation data do "
        "not show.",
    "verdict.predicted": "The command predicts a part of the residual, so the residual is not noise alone.",
    "verdict.none": "No effect in the library lowers the error of {before:error} by more than chance.",
    "verdict.missing_input":
        "An input is not recorded: {evidence}. No effect was looked for: any effect would only imitate this input. "
        "Record the input and add its channel, or leave out the rows in which the output moves by itself.",
    "verdict.missing_input_validation":
        "An input is not recorded in validation data: {evidence}. The errors there contain it.",
    "verdict.oscillation": "The machine oscillates: {evidence}. {cause}.",
    "verdict.oscillation_of_several": "The machine oscillates: {evidence}; {others:all} oscillate, too. {cause}.",
    "verdict.bounded":
        "The strength of {effect} ended at the bound of its search. It may be larger, or {effect} may only imitate "
        "another effect. Search within wider bounds.",
    "verdict.group":
        "These data cannot distinguish {group:all}: the errors with each of them differ by no more than chance.",
    "verdict.group_unexplained":
        "These data cannot distinguish {group:all}: the errors with each of them differ by no more than chance, or "
        "than the unexplained residual.",
    "verdict.two":
        "These data cannot tell which two of these are present: {group:listed}. Their refits differ by less than "
        "chance.",
    "verdict.two_unexplained":
        "These data cannot tell which two of these are present: {group:listed}. Their refits differ by less than "
        "chance, or than the unexplained residual.",
    "verdict.others": "Nearly as probable: {others:all}.",
    "verdict.label": "The label of {run:run} in matrix.yaml looks wrong ({what}): {evidence}.",
    "verdict.above_floor":
        "The error is larger than its noise floor explains. Drift and disturbances are a more probable cause than "
        "something that no effect in the library explains (probability {probability:probability}).",
    "verdict.correlated":
        "The residual is correlated from sample to sample. Drift and disturbances are a more probable cause than "
        "something that no effect in the library explains (probability {probability:probability}).",
    "verdict.unlisted": "Something remains that no effect in the library explains.",
    "verdict.unlisted_probable":
        "Something remains that no effect in the library explains (probability {probability:probability}).",
    "verdict.remains": "Part of the error remains unexplained.",
    "verdict.remains_probable":
        "Part of the error remains unexplained (probability {probability:probability}).",
    "verdict.limited":
        "The search was limited to {limit:effects} in all (--max-effects). More effects may explain the rest.",
    "verdict.not_repeated":
        "The noise floor was measured only at frequencies above those of the command, because no run was recorded "
        "twice. Record one run twice with the same command to learn how much of the error is noise.",
    "verdict.not_repeated_floor_unknown":
        "Record one run twice with the same command to learn how much of the error is noise.",
    "slip_forces":
        "Friction of {forward:quantity} forwards and {backward:quantity} backwards is the same to these data as "
        "friction of {friction:quantity} with a constant force of {constant:quantity}.",
    "inconsistent":
        "Fitted to each run alone, the model has {parameters:all}. A machine has one value of each, so these records "
        "determine no value of {names:all}. {cause}",
    "inconsistent.parameter": "{name} from {least:quantity} to {most:quantity}",
    "inconsistent.driven":
        "Either the machine differed from run to run, or the drive did not give what was commanded. Record the torque, "
        "force, pressure or current that drives the machine, as measured.",
    "inconsistent.moved":
        "Either the machine differed from run to run, or something that was not recorded acts on it. Repeat one run to "
        "learn whether the machine stays the same.",
    "group": "These data cannot distinguish {group:all}.",
    "group.two": "These data cannot tell which two of these are present: {group:listed}.",
    "contradicted.rises":
        "With {named} the error on validation data rises from {before:error} to {after:error}: either it only "
        "imitates something else, or the machine was different in these runs.",
    "contradicted.rises_by":
        "With {named} the error on validation data rises from {before:error} to {after:error} ({deviations:.1f} "
        "standard errors): either it only imitates something else, or the machine was different in these runs.",
    "contradicted.free_run":
        "With {named} the error of the free run of the validation data rises from {before:error} to {after:error}, "
        "more than the windows explain: either it only imitates something else, or the machine was different in "
        "these runs.",
    "contradicted.mean":
        "With {named} the error with its mean on validation data rises from {first:error} to {last:error} "
        "({deviations:.1f} standard errors; without the mean it falls from {before:error} to {after:error}): either it "
        "only imitates something else, or the machine was different in these runs.",
    "contradicted.unstable":
        "With {named} the model is {runs:unstable}; without, the error on validation data is {before:error}. "
        "Either it only imitates something else, or the machine was different in these runs.",
    "alone.rises":
        "With {equation}, and without the terms after it, the error on validation data rises from {before:error} to "
        "{after:error}.",
    "alone.unstable":
        "With {equation}, and without the terms after it, the model is {runs:unstable}; the error on validation data "
        "was {before:error}.",
    "alternative.better": "Another model explains more: {models:listed}. Choose it with --model.",
    "alternative.equal": "These data cannot distinguish this model from others: {models:listed}.",
    "dispensable.one":
        "With the proposed terms, which are not in the library, {effects:titles} is not needed: it only imitated "
        "them.",
    "dispensable.several":
        "With the proposed terms, which are not in the library, {effects:titles} are not needed: they only imitated "
        "them.",
    "horizon.runs":
        "These errors are over whole runs. The fit used windows of {fitted:.3g} s, in which the missing effect "
        "accumulates little error.",
    "free_run":
        "The free run of the estimation data leaves {error:error}. Disturbances like those over the windows, and "
        "errors of the parameters, would add up to {expected:error}: over windows something that acts hardly shows.",
    "horizon.windows":
        "These errors are over windows of {horizon:.3g} s. The fit used windows of {fitted:.3g} s, in which the "
        "missing effect accumulates little error.",
    "held":
        "A delay of {delay:quantity} is half of a sample interval: a command that a converter holds between its "
        "samples has that delay where it is read as straight lines. If yours was held, state hold: zoh and fit again: "
        "then the command delay is no effect of the machine.",
    "delay":
        "At low frequency the output lags the command by {time}. These data cannot tell which lag or delay causes "
        "it: {names:listed}.",
    "delay.before":
        "At low frequency the output lags the command by {time}, and by {before} in the fitted model. These data "
        "cannot tell which lag or delay causes it: {names:listed}.",
    "delay.without":
        "Without {without:titles} the output lags the command by {time} at low frequency. These data cannot tell "
        "which lag or delay causes it: {names:listed}.",
    "delay.without_before":
        "Without {without:titles} the output lags the command by {time} at low frequency, and by {before} in the "
        "fitted model. These data cannot tell which lag or delay causes it: {names:listed}.",
    "proposed": "The search proposes an addition that is not in the library: {terms:terms}.",
    "proposed.instead": "In place of {instead:titles}, the search proposes: {terms:terms}.",
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
    "why.shows": "It shows as: {looks}.",
    "why.would_show": "It would show as: {looks}.",
}  # fmt: skip
"""Why the data speak for or against an effect."""

STRUCTURES: Mapping[str, str] = {
    "structures": "No model was named. The first of these was chosen: {models:terms}.",
    "structures.one": "No model was named: {why}.",
    "structures.undone": "The records show {effects}. The models were compared by what they would be without.",
    "structure.of": "{machine}, {why}",
    "structure": "{facts:listed} ({why})",
    "structure.facts": "{facts:listed}",
    "structure.error": "held-out error {error:error}",
    "structure.error_over": "held-out error {error:error} over {seconds:.3g} s",
    "structure.parameters": "{count} parameters",
    "structure.effect": "{error:error} with {effects:titles}",
    "structure.probability": "probability {probability:probability}",
    "structure.more_probable": "with its effects it is the most probable",
    "structure.within": "the error is smaller with one effect, and no parameter is at its bound",
    "structure.simplest": "the simplest whose error is not larger",
    "structure.rather": "more probable than the first: if the machine is one, name it by --model {machine}",
    "structure.described": "the data set describes the machine",
    "structure.loop":
        "{machine} is used, a position loop, because the recorded output follows the command",
    "structure.position_loop":
        "{machine} is used, a position loop, because the recorded output follows the command; if a motor drives it and "
        "no oil, name that model (--model position_servo)",
    "structure.moved":
        "{machine} is used, because a force answers to a command in {unit}, which is taken as the motion; if the "
        "command is that of a valve or a loop, name the model (--model)",
    "structure.turning":
        "{machine} is used, an electric drive, because an angle follows an angle and nothing shows oil; if a valve "
        "drives it, state the supply pressure (actuator: {{supply_pressure: 210 bar}})",
    "structure.driven": "{machine} is used, because {driver} drives it and it shows what was recorded",
}  # fmt: skip
"""Why a model was chosen where none was named."""

SEARCH: Mapping[str, str] = {
    "verdict.unfitted":
        "The search was stopped early: there was no time to fit a model. Give it more "
        "time (--time, in s), or a fit (--fit).",
    "verdict.unstable_fit":
        "The fitted model is unstable on a run of the estimation data, so no effect was looked for.",
    "verdict.unranked":
        "The search was stopped early: there was no time to examine any effect. Give it more "
        "time (--time, in s).",
    "stage.no_time": "There was no time for the {stage}.",
    "stage.failed": "The stage '{stage}' failed: {why}. What was found before it is valid.",
    "stage.unusable": "{error}",
    "stage.memory": "it needs more memory than there is; use fewer or shorter runs",
    "stage.defect": "a defect of the program ({error}); its log has the details",
    "stages.missed": "Not examined: {stages:listed}.",
    "terms.stopped": "The search for unknown terms was stopped early.",
    "terms.left_out":
        "Of {looked_at} terms that were tried, {left_out} were left out: no model can contain them, or their "
        "contribution is not finite.",
    "terms.noise": "No unknown term was searched for: the error is measurement noise.",
    "refused": "Of {looked_at} terms that were tried, the best was rejected: {equation}.",
    "refused.given":
        "Of {looked_at} terms that were tried in addition to {effects:titles}, the best was rejected: {equation}.",
    "refused.little": "Its evidence on held-out data is {gain:.3g} nats, and {bar:.3g} are needed.",
    "refused.some_runs":
        "Its evidence on held-out data is {gain:.3g} nats ({bar:.3g} are needed), but the error of some runs rises.",
    "refused.error": "With it the error is {error:error}.",
    "refused.error_verify": "With it the error is {error:error} ({verify:error} on validation data).",
    "term.hypothesis": "{meaning} (a hypothesis: too few runs to confirm it)",
    "recommended":
        "`servoident fit {matrix} --start {file}` makes the fit with {effects:titles}. It begins where "
        "the diagnosis ended, at an error of {error:percent}.",
    "recommended.one_of":
        "`servoident fit {matrix} --start {file}` makes the fit with {effects:titles}; {taken:title} is one of those "
        "that these data cannot distinguish. It begins where the diagnosis ended, at an error of {error:percent}.",
    "recommended.compare":
        "`servoident fit {matrix} {options:words} --json without.json` makes the fit without {effects:titles}, "
        "`servoident fit {matrix} --start {file} --json with.json` the fit with {effects:them}, and "
        "`servoident compare {matrix} --fit without.json --fit with.json` compares the two.",
    "recommended.time":
        "`servoident diagnose {matrix} --time {seconds}` searches again for up to {seconds} s. Repeat your other "
        "options with it.",
    "recommended.more":
        "`servoident diagnose {matrix} --max-effects {most}` searches again for up to {most} effects in all. Repeat "
        "your other options with it.",
    "recommended.run":
        "`servoident next {matrix} --diagnosis {file} --out next-run` writes the proposed run, which determines the "
        "parameters better.",
    "recommended.run_distinguishes":
        "`servoident next {matrix} --diagnosis {file} --out next-run` writes the proposed run, which distinguishes "
        "{group:titles}.",
    "recommended.run_differs":
        "`servoident next {matrix} --diagnosis {file} --out next-run` writes the proposed run, on which the best "
        "effects of the ranking differ most.",
    "recommended.run_optional":
        "Optional: `servoident next {matrix} --diagnosis {file} --out next-run` writes a run that determines the "
        "parameters better.",
    "recommended.terms": "--terms N takes the first N of the proposed terms, 0 none.",
    "run.next": "Run a {conditions}.",
    "run.separates": "After a refit, {models:all} differ by {separation:.3g} standard deviations of the noise.",
    "run.typical": "A typical other run separates them by {typical:.3g}.",
    "run.so_far": "The runs so far separate them by {so_far:.3g}.",
    "run.inseparable": "No feasible run separates the models.",
    "run.information": "Expected information gain: {information:.2g} nats.",
    "run.std_errors": "The standard errors fall to {errors:all} of their present values.",
    "run.std_error": "{share:share} ({name})",
    "instead.unstable": "{names}, but with it the model is {unstable}",
    "instead.error": "{names} (error {error} on validation data)",
}  # fmt: skip
"""What a search for missing effects says beside its verdict."""
