"""Texts that readers stumbled over, one by one: none comes back to a page, a terminal or a document."""

from __future__ import annotations

import re
from functools import cache

GONE = (
    "as much is left that the record's own past does not foretell: it follows a drift",
    "chance, or than what is left could have made", "nats less is left that their own past does not foretell",
    "it tells runs apart, and does not explain them", "has no memory from sample to", "is the noise's",
    "Something is left that none of the listed effects explains",
    "No command was measured twice: part of it may be noise", "What helps on the fitted runs is",
    "and what could stand in the place of what was",
    "ended at the bound of its search: it may be larger, or stand for something else",
    "by which lag or delay these data cannot tell", "what was found, those forgave what it adds up to", "is doubted",
    "The error stays, but the runs' offsets become explained", "beside the command",
    "the error of eq. (17) does not see it", "of what its own past does not",
    "their difference shows what repeats and what is noise", "a verification by the data of the fit proves nothing",
    "strays by up to", "how it goes is not", "its mass, stiffness and damping count as the actuator's own",
    "they cost, no more", "other parameters make up for it",
    "known at best as a ratio to the moving mass, which is a convention here", "The model leaves",
    "had a mode too fast", "taken as white: a lower bound",
    "Random commands without a repeat cannot tell noise in the band from nonlinearity",
    "a better linear model could take", "what no model can take",
    "What the error on the runs to fit is made of; shares of its square, since the parts add",
    "The band holds 95 %, without the parabola that a standard error assumes", "each figure's own choice",
    "Choose a square of the map, or draw a band across it or the Bode plot: the other figures", "Report in one file",
    "Undo: back to the fit before", "The fit before it left", "No label is doubted by the search for what is missing",
    "Runs to verify only report. Runs whose labels do not fit their data are named",
    "which it is without the effect; the mark on it is the noise floor",
    "Helps by itself, but not beside what the search would add", "the search would add it",
    "others that do not help beyond chance", "What the search would add, step by step",
    "Evidence: logarithm of the factor by which the step made the held-out data more likely",
    "Search for what no list holds", "On runs that neither search nor choice saw",
    "A hypothesis: too few runs to confirm it on others", "Mend the label and fit again", "Mend…", "Leave as it is",
    "turned round", "Make the revision", "What reading changed or assumed", "No fault, no doubt",
    "A model reproduces", "as it looks", "What a file states is filled in; what none states is yours to say",
    "Runs that only verify; no fit sees them", "What is missing, and what is doubted", "Make the matrix",
    "The same bytes again lead to the same matrix", "Not all of it is explained; what helps is",
    "Its parameters are in force: nothing to do", "Its runs are here, but no fit is", "Look and mend",
    "It is being searched for what its model lacks",
    "An equation that redefines what a place of the chain hands on, with a strength at which",
    "held at their value unless a fit is given their bounds",
    "A state of its own, if it has one: it begins at 0, and its rate reads signals as they",
    "Choose a place to see the effects that live there", "The way to this fit",
    "The computer carries the structure but for its physical part", "none: the command is what is wanted",
    "RMS is the deviation of the difference over that of the second", "and the map over what is physical",
    "Take it along", "What the loop can stand, and how it follows",
    "or each sample of it follows from the one before",
    "hangs on the amplitude, nor of the lags and delays of effects",
    "What a silent worker had under way goes on elsewhere within 15 s", "Who bears it", "Raw runs that may go",
    "Limits of a batch come before those of every batch, parameter by parameter",
    "Of the sets in force; of one serial number all that ever were", "nats of the parameters: of the standard",
    "or teaches most of the parameters", "is what is left noise?", "chance: 1.00 %",
    "on stretches it was not fitted to", "what the model lacks, against its own signals",
    "dashed: what 95 % stay below · upright: the estimate", "Start, in the order of its end", "chosen to differ",
    "points: measured, fading with lost coherence", "nothing behind the lag",
    "share by which the zone lies to one side", "a loss in one direction of the load",
    "a start that waits for enough drive", "as the system", "Everybody else is given a token by the admin",
    "what no listed effect explains is called unexplained. Then the search goes on for the",
    "the simplest that is not worse is taken", "what the model lacks, and where",
    "of several parts of the way to the prediction the error is least, down to next to nothing",
    "is of use in one company and of none in another", "for want of an",
    "what promised nearly as much as they leave is refitted, too",
    "one with no more parameters comes first if, with one effect, it leaves less than 0.7 of",
    "A command is taken for that of a loop where it and what was recorded are lengths, or",
    "This page is for who wants to know beforehand", "the third is its answer already, two",
    "What a matrix does not state is not guessed",
    "what would have to be added at a place of the chain, as a function of a signal inside the",
    "on the branch next to the model's", "which is in force, does it keep to its limits, is the process in control",
    "has to be mended, a *doubt* looked at, a *note* known",
    "Should it wake, what it writes about the job is refused: every turn at a job has a",
    "What is in force needs nothing. The page is drawn anew", "A sample more than five standard",
    "tests/reference/qian_reference.py",
    "measure on your machine, and the page is yours. Nothing is to be busy for more than",
    "from the very lines of the kernel", "What the catalogue lacks you write down: one small file, no code",
    "the flow gain hangs on the supply pressure as it was measured",
    "Disks are filled where root runs it, clocks are stepped where",
)  # fmt: skip
"""A part of each, long enough to be it."""
KEPT = {
    "Another model explains more": "it is short and plain, and the next sentence says how to choose that model",
    "none is lost": "a plain clause, of events and of parameters",
    "what does not repeat": "what noise is, where the noise floor is explained",
}
"""Parts that are still there, and why."""


def has(text: str, part: str) -> bool:
    """Whether a text has a part, however its lines are broken; of one or two words, as a label of its own only."""
    if len(part.split()) < 3:
        return part in map(str.strip, text.split("\n"))
    return part in in_one_line(text)


@cache
def in_one_line(text: str) -> str:
    """The text with a space for each break."""
    return re.sub(r"\s+", " ", text)
