"""The texts of the data check, and of the likely causes of a fit that explains almost nothing, by key."""

from __future__ import annotations

from collections.abc import Mapping

CHECKS: Mapping[str, str] = {
    "check.none": "No errors, no warnings.",
    "check.band_narrow":
        "the command of {run:run} is called blwn, but {share:share} of its power lies below {edge:.3g} Hz instead of "
        "about 76 Hz; higher frequencies are not excited and not identifiable: check the generator, the sample rate "
        "and kind",
    "check.band_wide":
        "the command of {run:run} is called blwn, but {share:share} of its power lies below {edge:.3g} Hz instead of "
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
        "displacement of {run:run} is {ratio:.3g} times the command at {low:.2g}-{high:.2g} Hz, near {factor:g}, the "
        "factor between {units:units}; correct the unit or scale of the channel",
    "check.unrelated":
        "displacement of {run:run} hardly follows the command (coherence {coherence:.2f} where it is excited); check "
        "that both columns are the right ones and of this run",
    "check.force_sign":
        "force of {run:run} is {ratio:.2g} times what its specimen needs: the sign is wrong; set invert: true on "
        "force, which is positive on the specimen along +x",
    "check.offset_above":
        "the mean displacement of {run:run} is {millimetres:.3g} mm above the command ({share:share_of} its standard "
        "deviation). The error of eq. (17) ignores constant offsets. {remedy}",
    "check.offset_below":
        "the mean displacement of {run:run} is {millimetres:.3g} mm below the command ({share:share_of} its standard "
        "deviation). The error of eq. (17) ignores constant offsets. {remedy}",
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
        "samples of {run:run} are missing ({missing}), and the phase after a gap is shifted. Repeat the run, or use "
        "the longest part without a gap, rows: [{first}, {end}]",
    "check.gaps_filled":
        "samples of {run:run} are missing ({missing}), and they were interpolated. The longest part without a gap is "
        "rows: [{first}, {end}]",
    "check.jitter":
        "the clock of {run:run} has a jitter of up to {jitter:.3g} samples, and a constant sample rate is assumed. "
        "Record with a hardware clock, or print the time with more digits",
    "check.jitter_held":
        "the clock of {run:run} has a jitter of up to {jitter:.3g} samples. The record was resampled to {rate:.6g} Hz "
        "by its time column, with the steps of the held command at their time",
    "check.jitter_interpolated":
        "the clock of {run:run} has a jitter of up to {jitter:.3g} samples. The record was resampled to {rate:.6g} Hz "
        "by its time column, by interpolation",
    "check.few_samples":
        "{run:run} has {samples:.2g} samples per cycle at {highest:.3g} Hz, and {share:share} of the power of the "
        "command is below that. Use at least {least:.3g} Hz",
    "check.too_quick":
        "the sample rate of {run:run} is too low: {share:share} of the step response happens within {samples} samples. "
        "Use at least {least:.3g} Hz",
    "missing_input":
        "in {run:run} the {output} started to move {count} times although no recorded input moved, first at "
        "{start:.4g} {unit}; in {share:percent} of the samples in which all inputs rested it moved faster than "
        "{speed:quantity}, half the speed of the slowest of these starts",
    "check.missing_input":
        "{evidence}. An input is not recorded: add its channel, or keep only the rows in which it rests",
    "check.late_start":
        "in {run:run} the command acts from the first samples on, but the {output} stands still for {late:quantity}; "
        "after {count} later steps it sets out within {usual:quantity}. Its drive was probably not on yet: leave out "
        "the rows before {first:quantity}, with rows",
    "oscillation.steady":
        "in {run:run} the {output} swings by itself at {frequency:quantity} with an amplitude of {amplitude:quantity}, "
        "which no recorded input explains",
    "oscillation.growing":
        "in {run:run} the {output} swings by itself at {frequency:quantity}, and the amplitude doubles in "
        "{time:quantity}",
    "oscillation.loop":
        "The loop is at its stability limit, or something periodic disturbs it. Reduce the gain of the loop, or its "
        "delay, or leave the run out of the fit: no linear model has a limit cycle",
    "oscillation.open":
        "State the gain if a loop is closed, and reduce it; else look for a source that is not recorded",
    "check.self_oscillation": "{evidence}. {cause}",
    "check.closed_loop":
        "the command of {run:run} depends on the measured output, so a controller made it: the output predicts "
        "{share:percent} of the innovations of the command. Use the reference of the controller as the command and "
        "state controller or gain, or set closed_loop: false if there is no feedback",
    "check.amplitude":
        "the command of {run:run} has an RMS of {rms:.4g} {unit}, but the stated amplitude is {stated:.4g} {unit} "
        "({ratio:.3g} times). Correct amplitude, or the unit or scale of the command",
    "check.amplitude_unit":
        "the command of {run:run} has an RMS of {rms:.4g} {unit}, but the stated amplitude is {stated:.4g} {unit} "
        "({ratio:.3g} times, near {factor:g}, the factor between {units:units}). Correct amplitude, or the unit or "
        "scale of the command",
    "check.amplitude_peak":
        "the command of {run:run} has an RMS of {rms:.4g} {unit}, but the stated amplitude is {stated:.4g} {unit} "
        "({ratio:.3g} times), which seems to be the peak of the sine. State the RMS as amplitude",
    "check.amplitude_peak_to_peak":
        "the command of {run:run} has an RMS of {rms:.4g} {unit}, but the stated amplitude is {stated:.4g} {unit} "
        "({ratio:.3g} times), which seems to be the peak-to-peak value of the sine. State the RMS as amplitude",
    "check.delay":
        "the displacement of {run:run} lags the command by {samples:.1f} samples more than {poles} poles explain. "
        "Possible causes: channels sampled one after another, a filter, a delay of the controller. Shift the channel, "
        "or add the effect command_delay",
    "check.delay_all":
        "the displacement lags the command by {samples:.1f} samples more than {poles} poles explain, in all {count} "
        "runs that show it. Possible causes: channels sampled one after another, a filter, a delay of the controller. "
        "Shift the channel, or add the effect command_delay",
    "check.lead":
        "the displacement of {run:run} leads the command by {samples:.1f} samples, which no actuator can. Its channels "
        "are shifted or exchanged: correct columns or rows",
    "check.lead_all":
        "the displacement leads the command by {samples:.1f} samples in all {count} runs that show it, which no "
        "actuator can. The channels are shifted or exchanged: correct columns or rows",
    "check.lead_or_rate":
        "the displacement of {run:run} leads the command by {samples:.1f} samples. Either its channels are shifted or "
        "exchanged: correct columns or rows. Or it answers the rate of the command, too: a feed-forward, or a mass on "
        "a base that moves",
    "check.lead_all_or_rate":
        "the displacement leads the command by {samples:.1f} samples in all {count} runs that show it. Either the "
        "channels are shifted or exchanged: correct columns or rows. Or it answers the rate of the command, too: a "
        "feed-forward, or a mass on a base that moves",
    "check.skew":
        "the displacement of {run:run} lags the command by {samples:.1f} samples more than {poles} poles explain; the "
        "median of all runs is {middle:.1f} samples. Look for a shift between its channels (rows, another recorder) or "
        "a wrong label",
    "check.skew_lead":
        "the displacement of {run:run} leads the command by {samples:.1f} samples; in the median of all runs it lags "
        "by {middle:.1f} samples. Look for a shift between its channels (rows, another recorder) or a wrong label",
    "check.duplicate":
        "runs {runs:all} contain the same samples, so they count twice in a fit. Keep one of them, or correct file, "
        "rows or columns",
    "check.duplicate_verify":
        "runs {runs:all} contain the same samples, so the validation is not independent. Keep one of them, or correct "
        "file, rows or columns",
    "check.means":
        "the means of {channel} differ between the runs by {ratio:.3g} times what it varies within a run. A fit hardly "
        "counts them, since the zero may have been set for each run. If it was not, say zeroed: false of the channel",
    "check.repeat":
        "runs {runs:all} repeat the same command under the same conditions. Their difference is used to estimate the "
        "noise",
    "check.repeat_shifted":
        "runs {runs:all} repeat the same command under the same conditions. Their difference is used to estimate the "
        "noise. Compared with {first}, {shifts:all}: the shift is removed first",
    "check.repeat_unlabelled":
        "runs {runs:all} have the same command, and no label separates them. Their difference is used to estimate the "
        "noise. If a condition was changed, state it: specimen, gain, amplitude",
    "check.repeat_unlabelled_shifted":
        "runs {runs:all} have the same command, and no label separates them. Their difference is used to estimate the "
        "noise. Compared with {first}, {shifts:all}: the shift is removed first. If a condition was changed, state it: "
        "specimen, gain, amplitude",
    "shift.earlier": "{run} starts {samples:samples} earlier",
    "shift.later": "{run} starts {samples:samples} later",
    "check.beyond_rig":
        "{run:run} leaves a limit of the rig: its {what} of {peak:quantity} is {share:share_of} {allowed:quantity}. "
        "{kept:.3g} times the command would keep the limit {limit}. Reduce the command, or correct the unit of the "
        "channel or the limit",
    "check.scale":
        "{channel} of {run:run} moves {ratio:.3g} times as far for its command as that of {others:first}, near "
        "{factor:g}, the factor between {units:units}. Correct the unit or scale of one of its channels",
    "check.unit_factor": "{what}. {remedy}",
    "factor": "near {value:.4g}",
    "factor.units": "near {value:.4g}, the factor between {units:units}",
    "unit.rate":
        "{run:run} is sampled at {rate:.6g} Hz and lasts {duration:.4g} s: the rate is {ratio:.4g} times that of "
        "{others:first} ({factor}), though sample by sample it is like them",
    "unit.duration":
        "{run:run} lasts {duration:.4g} s, {ratio:.4g} times as long as {others:first} ({factor}), and answers its "
        "command as much more slowly",
    "unit.size": "{channel} of {run:run} is {ratio:.4g} times as large as that of {others:first} ({factor})",
    "unit.correct_rate": "Correct the unit of its time, or its sample rate",
    "unit.correct_time": "Correct the unit of its time, or resample",
    "unit.correct_scale": "Correct its unit or scale",
    "unit.correct_command": "Correct its unit or scale, or state the amplitude that was meant",
    "check.no_piston_area":
        "piston_area is not given: only the ratios {ratios:all} are identifiable. State it to get the parameters "
        "themselves",
    "check.no_gain":
        "gain is not given for {runs:first}: Kp = 1 is assumed, so Z0 means Z0 times Kp. State the gain",
    "check.no_specimen":
        "specimen is not given for {runs:first}: its mass, stiffness and damping are included in m0 and c0. State the "
        "specimen",
    "check.one_condition":
        "all estimation runs have the same specimen and gain: some parameters will be identifiable only in "
        "combination. Measure other specimens and gains",
    "check.no_fit_runs": "every run is validation data, and none is left to fit. Set use: fit on some runs",
    "check.too_short":
        "the estimation data have {samples:samples} in all, too few for the parameters of a model. Record at least "
        "{least}, better some seconds",
    "check.no_verify_runs":
        "there are no validation data, so a fit cannot be judged on data that it has not used. Set use: verify on a "
        "run",
    "check.extrapolation":
        "{run:run} is validation data at Kp = {gain:g}, outside the {lowest:g} to {highest:g} of the estimation data. "
        "Its error includes an extrapolation",
}  # fmt: skip
"""Findings of the data check."""

CAUSES: Mapping[str, str] = {
    "cause.unit": "a wrong unit of a channel or of the time",
    "cause.unit_of": "a wrong unit: {what}",
    "cause.sign": "a channel with the wrong sign, or from another run",
    "cause.no_loop":
        "no loop compares {channel} with the command, as where a mechanism, a valve or a column of air lies between "
        "them (--model first_order)",
    "cause.model": "the wrong model (--model, now {model})",
    "cause.offset": "a command offset at rest, which the machine integrates (null_bias)",
    "cause.bounds_large":
        "the bounds given for {name} are {given}, {times} times the range of this machine ({remedy})",
    "cause.bounds_small":
        "the bounds given for {name} are {given}, 1/{times} of the range of this machine ({remedy})",
    "cause.value_large":
        "the value given for {name} is {given}, {times} times the range of this machine ({remedy})",
    "cause.value_small": "the value given for {name} is {given}, 1/{times} of the range of this machine ({remedy})",
    "cause.write": "write {value} if {unit} were meant",
    "cause.searched": "without it {range} is searched",
    "hardly":
        "The model explains almost nothing: the error is {error:error} of the output. Likely causes: {causes:terms}.",
    "cause.conditions": "the machine, its load or its operating point differs in that run",
    "cause.held":
        "a controller holds the {channel} and makes the force (then name the command force, set output: force, and the "
        "motion drives)",
    "contradicted":
        "Validation data contradict the model: of {run:run} it leaves {error:error}, where the mean of the run leaves "
        "100 %. Likely causes: {causes:terms}.",
    "missing_input.fit":
        "An input is not recorded: {evidence}. Add its channel, or keep only the rows in which it rests.",
    "transducer_offset":
        "The transducer of {channel} reads {offset} {side} the model, with a standard error of {error}. This offset is "
        "part of the model in RMSE and in the error with the mean.",
    "transducer_offset.temperature":
        "By the model the temperature without a command is {offset} {side} 0 °C, with a standard error of {error}. "
        "This offset is part of the model in RMSE and in the error with the mean.",
    "known_zero":
        "The runs begin at rest, where {channel} reads {value}, with a standard error of {error}: its mean counts in "
        "the fit.",
    "known_zero.left":
        "The model does not explain the mean of {channel}: a constant force, a bias or an input may be missing.",
    "unstable": "The model is unstable. Likely cause: {causes:terms}.",
}  # fmt: skip
"""What a fit says that is hardly better than none."""
