"""Terms that stand in place of what the catalogue named: where runs to verify speak for the catalogue, that is said."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from ident.diagnosis.discovery.discovery_result import DiscoveryResult, RejectedTerm
from ident.diagnosis.discovery.proposal import Proposal
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.sentences import dispensable_sentence, proposed_text
from ident.diagnosis.verdict import Findings, conclude
from ident.diagnosis.verification import Contradiction, VerifyChange
from ident.run import Run

TIMES = np.arange(2000) / 1000.0


def verify() -> tuple[Run, ...]:
    wave = 1e-3 * np.sin(2 * np.pi * 5 * TIMES)
    return tuple(Run(f"v{n}", "", 1000.0, {"command": wave, "displacement": wave}, use="verify") for n in range(2))


@dataclass
class Leaving:
    """A model that leaves noise of so large a share of the displacement on runs to verify."""

    share: float
    runs: tuple[Run, ...] = field(default_factory=verify)

    @property
    def fitness(self) -> SimpleNamespace:
        return SimpleNamespace(horizon=None, matrix=SimpleNamespace(of_use=lambda _use: self.runs))

    @property
    def on_verify_runs(self) -> tuple[list[np.ndarray], None]:
        random = np.random.default_rng(1)
        return [
            self.share * np.std(run.measured) * random.standard_normal(len(run.measured)) for run in self.runs
        ], None


def found(share: float) -> DiscoveryResult:
    last = Proposal(
        place=("force",),
        equation="R = R + s * (v**3)",
        effect={"name": "proposed_1"},
        error={"fit": 0.05, "verify": share},
    )
    return DiscoveryResult(proposals=(last,), refit=cast(FittedModel, Leaving(share)))


def test_a_verify_error_above_the_catalogues_is_said_first_with_both() -> None:
    told = found(0.26).instead(cast(FittedModel, Leaving(0.16)), ("play", "dead_zone"))
    against = told.proposals[-1].contradicted
    assert against is not None
    assert against.instead_of == ("play", "dead_zone")
    assert (against.before, against.after) == pytest.approx((0.16, 0.26), rel=0.05)
    text = proposed_text(told.proposals)
    assert text.startswith(
        "With R = R + s * (v**3) in place of play and dead zone the error on validation data rises from 16"
    )
    assert "In place of play and dead zone, the search proposes: R = R + s * (v**3)." in text


@pytest.mark.parametrize("share", [0.155, 0.10])
def test_one_that_is_no_worse_only_says_what_it_stands_instead_of(share: float) -> None:
    told = found(share).instead(cast(FittedModel, Leaving(0.16)), ("play",))
    assert told.proposals[-1].contradicted is None
    assert told.proposals[-1].instead_of == ("play",)
    assert proposed_text(told.proposals).startswith("In place of play, the search proposes: ")


def test_without_runs_to_verify_nothing_is_known() -> None:
    assert found(0.26).instead(cast(FittedModel, Leaving(0.16, ())), ("play",)).proposals[-1].contradicted is None


def refused(equation: str, nats: float, *beside: str, fit: float = 0.3, verify: float | None = 0.4) -> DiscoveryResult:
    error = {"fit": fit, "held_out": 0.31, "verify": verify}
    best = RejectedTerm(equation=equation, log_likelihood_gain=nats, bar=13.4, beside=beside, error=error)
    return DiscoveryResult(rejected=best, looked_at=4000)


def test_of_two_searches_what_was_refused_and_would_leave_less_is_told() -> None:
    """Nats count from the model that a search began with: 557 from a linear one leave more than 7 from a better one."""
    plain = refused("Q = Q + s * (max(Q, 0) * w)", 10.3)
    beside = refused("R = R + s * (x)", 6.9, "dead_zone", fit=0.31)
    from_linear = refused("e = e + s * (P)", 557.0, fit=0.5)
    for worse in (beside, from_linear):
        for told in (plain.or_rejected(worse), worse.or_rejected(plain)):
            assert (told.rejected, told.looked_at) == (plain.rejected, 8000)
    assert plain.rejected is not None
    assert beside.rejected is not None
    assert "max(Q, 0) * w). Its evidence on held-out data is 10.3 nats" in plain.rejected.sentences(8000)
    assert plain.rejected.sentences(8000).endswith(
        "13.4 are needed. With it the error is 30.0 % (40.0 % on validation data)."
    )
    assert (
        "in addition to dead zone, the best was rejected: R = R + s * (x). Its evidence on"
        in beside.rejected.sentences(8000)
    )
    assert found(0.1).or_rejected(plain).rejected is None
    unsteady = refused("w = w + s * (w * abs(v))", 1291.0).rejected
    assert unsteady is not None
    assert "(13.4 are needed), but the error of some runs rises. With it the" in unsteady.sentences(8000)


def test_where_a_verify_run_cannot_be_followed_a_refused_term_tells_no_error_of_it() -> None:
    best = refused("R = R + s * (x)", 6.9, verify=None).rejected
    assert best is not None
    assert best.sentences(1).endswith("With it the error is 30.0 %.")


def test_what_the_terms_do_without_is_named_no_more() -> None:
    """Leak and asymmetry stood for a recorder that bends: with its term the model does as well without them."""
    named = ("entrained_air", "one_way_leakage", "gain_asymmetry")
    term = replace(found(0.1).proposals[-1], beside=("entrained_air",))
    needless = DiscoveryResult(proposals=(term,)).dispensable(named)
    assert needless == ("one_way_leakage", "gain_asymmetry")
    before = Findings(
        added=named,
        alternatives=(("entrained_air", "backlash"), ("gain_asymmetry", "null_bias")),
        verify=(VerifyChange("gain_asymmetry", 0.1, None),),
    )
    after = conclude(replace(before, dispensable=needless))
    assert (after.effects, after.stood_in) == (("entrained_air",), needless)
    assert (after.standing, after.contradicted_by) == ("stand_in", ())
    assert after.indistinguishable == (("entrained_air", "backlash"),)
    assert conclude(replace(before, dispensable=named)).standing == "nothing"
    told = "one way leakage and gain asymmetry are not needed: they only imitated them."
    assert next(dispensable_sentence(needless)).endswith(told)


@pytest.mark.parametrize(
    "doubt",
    [
        {"hypothesis": True},
        {"instead_of": ("entrained_air",)},
        {"contradicted": Contradiction("proposed_1", 0.1, 0.2, 3.0)},
    ],
)
def test_a_doubtful_term_takes_no_name_away(doubt: dict[str, Any]) -> None:
    term = replace(found(0.1).proposals[-1], **doubt)
    assert DiscoveryResult(proposals=(term,)).dispensable(("entrained_air",)) == ()
    assert DiscoveryResult().dispensable(("entrained_air",)) == ()
