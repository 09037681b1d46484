"""The verdict of a diagnosis: a pure function of its findings. The whole rule stands on this page.

The findings come from the stages before: which effects were added from the selection (the rule is `worth_adding` in
:mod:`ident.diagnosis.evidence.rule`), their groups from :mod:`ident.diagnosis.ambiguity`, the others from
:mod:`ident.diagnosis.challenges`.

The *named* effects are the effects that the selection added, without three kinds. A *dispensable* effect is one without
which the model does as well, given terms that were confirmed. An *unconfirmed* effect was added last, and validation
data show nothing of it, although it would lower their error if it acted. Effects are *by chance* where it is more
probable than not that nothing is missing. The residual is *unexplained* unless it is
noise. A *group* are effects that the data cannot tell apart. The verdict stands in one of four ways:

* *nothing*: no effect is named;
* *contradicted*: the error on validation data rises with a named effect;
* *stand_in*: unmodelled dynamics remain or may remain. The residual is unexplained; or a dispensable effect was
  contradicted; or no noise floor is known and a named strength ended at the bound of its search. `because` has which;
* *found*: none of these.

The residual is noise where its size is that of the noise floor, or where no floor is known, where it has no memory.
Where no command was repeated the floor is not known in the band of the command; there a residual of up to twice the
floor is also noise if the inputs predict nothing of it. The verdict follows this test. The probability that something
unlisted acts follows from the gains of the refitted models, and from this test. Validation data are not part of a
probability: an effect that they contradict may have a large one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import takewhile

from ident.diagnosis.criteria import CRITERIA, Criteria
from ident.diagnosis.evidence.evidence import BlockMean
from ident.diagnosis.evidence.probability import NOTHING, Probabilities, SetGains, probabilities
from ident.diagnosis.result import Alternative, Explanation, NoiseTest, Suspect, Verdict
from ident.diagnosis.verification import Contradiction, Reason, Standing, VerifyChange

Names = tuple[str, ...]


@dataclass(frozen=True)
class Residual:
    """The error on the estimation data, and its noise floor.

    `floor` is the error that noise alone makes, None where it is not known, and `spread` its relative standard
    deviation. `correlation` is that of the residual with itself a few samples later, which decides where no floor is
    known. A floor from a spectrum above the band of the command is a lower bound: `predicted`, the share of the
    residual that the inputs predict, decides where coloured noise may have made the error; None elsewhere. `excess` is
    the share of the floor by which the error may exceed it, None for the usual share; a bench has its own.
    """

    error: float
    floor: float | None
    spread: float = 0.0
    correlation: float = 0.0
    predicted: BlockMean | None = None
    excess: float | None = None


@dataclass(frozen=True, kw_only=True)
class Findings:
    """The findings of all stages of a diagnosis, in numbers and names.

    `added` are the effects of the selection, in their order; `alternatives` has for each the effects that are
    indistinguishable from it, itself included, and `compared` the numbers by which they are; `competing` are
    effects that are as probable in its place and in no group with it. `lag_pairs` are two added lags, and the lags
    of which any two do as well. `residual` is None where there was no time for the test of noise; `set_gains` are
    the gains of all sets of effects that were refitted. `verify` has the change of the validation error by each
    added effect; `at_bound` are effects whose strength ended at the bound of its search, `dispensable` are effects
    without which the model does as well, given confirmed terms. `suspects` are runs with a doubtful label,
    `elsewhere` are explanations by other machines that are as good.
    """

    added: Names = ()
    alternatives: Sequence[Names] = ()
    compared: Sequence[Alternative] = ()
    competing: Sequence[Alternative] = ()
    lag_pairs: Sequence[Names] = ()
    residual: Residual | None = None
    set_gains: SetGains | None = None
    verify: Sequence[VerifyChange] = ()
    at_bound: Names = ()
    dispensable: Names = ()
    suspects: Sequence[Suspect] = field(default=())
    elsewhere: Sequence[Explanation] = field(default=())


def is_noise(residual: Residual, criteria: Criteria = CRITERIA) -> bool:
    """Whether the residual is noise alone: below its limit, or no more predicted by the inputs than chance is; where no
    floor is known, without memory."""
    test = noise_test(residual, criteria)
    if test.correlation is not None:
        return not test.correlation > test.limit
    return test.error < test.limit or (test.predicted is not None and test.predicted <= (test.predicted_limit or 0.0))


def noise_test(residual: Residual, criteria: Criteria = CRITERIA) -> NoiseTest:
    """The error and its limit, the floor and a margin for its own error and for chance; the predicted share and its
    limit, the share that matters and a margin for chance; without a floor the correlation of the residual with itself
    and its limit."""
    if residual.floor is None:
        return NoiseTest(residual.error, criteria.noise.noise_correlation, correlation=residual.correlation)
    margin = criteria.evidence.floor_margin if residual.excess is None else 1.0 + residual.excess
    limit, share = (margin + criteria.noise.floor_deviations * residual.spread) * residual.floor, residual.predicted
    if share is None:
        return NoiseTest(residual.error, limit, residual.floor)
    most = criteria.evidence.share + share.bound(criteria.evidence)
    return NoiseTest(residual.error, limit, residual.floor, predicted=share.mean, predicted_limit=most)


def contradicts(change: VerifyChange, criteria: Criteria = CRITERIA) -> bool:
    """Whether validation data contradict an effect: the error rises beyond chance; its rise is infinite where the model
    is unstable."""
    return change.rise > criteria.verification.deviations * change.std_error


def shows_nothing(change: VerifyChange, criteria: Criteria = CRITERIA) -> bool:
    """Whether validation data show nothing of an effect that they would show if it acted as it was fitted.

    The validation error does not fall beyond chance, and its fall is beyond chance less than the fall that is `due` if
    the effect acts. Where the mean of the output counts in the fit, `rise` and `due` are of the error with its mean,
    and the error without its mean must not fall beyond chance either (`fall_without_mean`, 0 where the mean does not
    count): a mean that the model does not explain may hide an effect that the residual about it shows.
    """
    deviations, fall = criteria.verification.deviations, -change.rise
    chance = deviations * change.std_error
    if contradicts(change, criteria) or _lowers_about_mean(change, deviations):
        return False
    return fall <= chance < change.due - fall


def lowers(change: VerifyChange, criteria: Criteria = CRITERIA) -> bool:
    """Whether the error on validation data falls beyond chance, with the mean of the output or about it."""
    deviations = criteria.verification.deviations
    return -change.rise > deviations * change.std_error or _lowers_about_mean(change, deviations)


def _lowers_about_mean(change: VerifyChange, deviations: float) -> bool:
    """Whether the error without the mean falls beyond chance, where the mean counts in the fit."""
    return change.fall_without_mean > deviations * change.std_error_without_mean


def confirms(change: VerifyChange, criteria: Criteria = CRITERIA) -> bool:
    """Whether validation data confirm an effect: they neither contradict it nor fail to show it."""
    return not contradicts(change, criteria) and not shows_nothing(change, criteria)


def contradiction(change: VerifyChange | None) -> Contradiction | None:
    """The contradiction of an effect or a term by validation data; None where they do not contradict it."""
    return None if change is None or not contradicts(change) else change.contradiction()


def conclude(findings: Findings, criteria: Criteria = CRITERIA) -> Verdict:
    """The verdict that follows from the findings; its sentences are the report's."""
    unconfirmed = _unconfirmed(findings, criteria)
    of_sets = _probabilities(findings, criteria)
    supported = tuple(name for name in findings.added if name not in (*findings.dispensable, *unconfirmed))
    by_chance = supported if of_sets is not None and of_sets.nothing > 0.5 else ()
    named = () if by_chance else supported
    contradicted = [change for change in findings.verify if contradicts(change, criteria)]
    against = [change for change in contradicted if change.effect not in (*findings.dispensable, *by_chance)]
    cleared = any(change.effect in findings.dispensable for change in contradicted)
    reasons = _reasons(findings, named, cleared, criteria)
    standing = _standing(named, bool(against), reasons)
    groups = _groups(findings, named)
    return Verdict(
        effects=named,
        standing=standing,
        because=reasons if standing == "stand_in" else (),
        contradicted_by=tuple(change.effect for change in against),
        contradictions=tuple(change.contradiction() for change in against),
        indistinguishable=groups,
        alternatives=tuple(
            compared for compared in findings.compared if any(compared.instead_of in group for group in groups)
        ),
        competing=tuple(effect for effect in findings.competing if effect.instead_of in named),
        suspects=tuple(findings.suspects),
        unexplained=_unexplained(findings, criteria),
        noise_test=None if findings.residual is None else noise_test(findings.residual, criteria),
        at_bound=findings.at_bound,
        elsewhere=tuple(findings.elsewhere),
        stood_in=findings.dispensable,
        unconfirmed=unconfirmed,
        by_chance=by_chance,
        probability=None if of_sets is None else _probability(findings, of_sets, named, groups, criteria),
        probabilities={} if of_sets is None else of_sets.named,
        group_probabilities=() if of_sets is None else tuple(_of_group(group, of_sets, named) for group in groups),
    )


def _probabilities(findings: Findings, criteria: Criteria) -> Probabilities | None:
    """The probabilities of the sets of effects; beyond a set whose residual is noise nothing can be gained."""
    if findings.set_gains is None:
        return None
    added, sets = frozenset(findings.added), findings.set_gains
    if not _unexplained(findings, criteria) and added in sets.gains:
        sets = replace(sets, most=min(sets.most, sets.gains[added]))
    return probabilities(sets, criteria.evidence)


def _probability(
    findings: Findings, of_sets: Probabilities, named: Names, groups: Sequence[Names], criteria: Criteria
) -> float:
    """The probability that every named effect, or one of its group, acts; without a name, that no listed effect acts,
    and where the residual is noise, that nothing unlisted does either."""
    if named:
        return of_sets.of(next((group for group in groups if name in group), (name,)) for name in named)
    return of_sets.nothing + of_sets.with_unlisted[NOTHING] * _unexplained(findings, criteria)


def _of_group(group: Names, of_sets: Probabilities, named: Names) -> float:
    """The probability that as many effects of a group act as are named: one, or two of a lag pair."""
    return of_sets.of([group] * max(len({*group} & {*named}), 1))


def _unexplained(findings: Findings, criteria: Criteria) -> bool:
    """Whether the residual is not known to be noise; it is not known where there was no time for the test."""
    return findings.residual is None or not is_noise(findings.residual, criteria)


def _reasons(
    findings: Findings, named: Names, dispensable_contradicted: bool, criteria: Criteria
) -> tuple[Reason, ...]:
    """Why the named effects may stand for others."""
    residual = findings.residual
    floor_known = residual is not None and residual.floor is not None
    holds: dict[Reason, bool] = {
        "untested": residual is None,
        "unexplained": residual is not None and not is_noise(residual, criteria),
        "at_bound": bool({*findings.at_bound} & {*named}) and not floor_known,
        "dispensable_contradicted": dispensable_contradicted,
    }
    return tuple(reason for reason, is_so in holds.items() if is_so)


def _standing(named: Names, against: bool, reasons: Sequence[Reason]) -> Standing:
    """How the named effects stand."""
    if not named:
        return "nothing"
    if against:
        return "contradicted"
    return "stand_in" if reasons else "found"


def _unconfirmed(findings: Findings, criteria: Criteria) -> Names:
    """The effects at the end of the selection of which validation data show nothing.

    An effect that was added earlier may show only together with later ones, so it stays.
    """
    nothing = {change.effect for change in findings.verify if shows_nothing(change, criteria)}
    asked = [name for name in findings.added if name not in findings.dispensable]
    return tuple(reversed([*takewhile(lambda name: name in nothing, reversed(asked))]))


def _groups(findings: Findings, named: Names) -> tuple[Names, ...]:
    """Groups of effects that the data cannot tell apart, all of whose added effects are named; the lags of a pair are
    one group."""
    alone = (group for group in findings.alternatives if len(group) > 1)
    groups = (
        *(group for group in alone if not any({*group} <= {*pair} for pair in findings.lag_pairs)),
        *findings.lag_pairs,
    )
    return tuple(group for group in groups if {*group} & {*findings.added} <= {*named})


def is_improbable(probability: float | None, of_all: Mapping[str, float]) -> bool:
    """Whether an effect, with all of its group, is less probable than not, and another explanation is more probable.

    The other explanation is something unlisted that is more probable than not, or that nothing is missing. The median
    model does not have the effect then (Barbieri and Berger 2004). Otherwise the effect is one of several listed ones
    that may act. `of_all` has the probabilities of :attr:`Probabilities.named`.
    """
    if probability is None or probability >= 0.5:
        return False
    return of_all.get("unlisted", 0.0) >= 0.5 or of_all.get("nothing", 0.0) > probability


def is_rather_noise(of_all: Mapping[str, float]) -> bool:
    """Whether it is more probable that nothing unlisted acts, although the residual is above its limit of noise.

    False where the probabilities, those of :attr:`Probabilities.named`, are not known.
    """
    return of_all.get("unlisted", 1.0) < 0.5
