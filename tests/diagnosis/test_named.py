"""What a diagnosis names, as a fit takes it."""

from __future__ import annotations

import pytest

from ident.diagnosis.discovery.proposal import Proposal
from ident.diagnosis.named import names, with_named
from ident.diagnosis.result import Diagnosis, Ranked, Verdict
from ident.errors import Unusable
from ident.fit.settings import Settings

OWN = {
    "name": "overlap",
    "place": "spool",
    "equation": "w = w - clip(w, -h, h)",
    "strength": {"symbol": "h", "unit": "mm", "lower": 0, "upper": 1},
}
TERMS = tuple(
    {
        "name": f"proposed_{power}",
        "place": "spool",
        "equation": [f"w = w - s * w**{power}"],
        "strength": {"symbol": "s", "unit": f"1/m^{power - 1}", "lower": -1.0, "upper": 1.0},
    }
    for power in (2, 3)
)
FOUND = Diagnosis(
    effects=("sensor_lag",),
    candidates=(Ranked(effect="dead_zone"), Ranked(effect="overlap")),
    verdict=Verdict(),
    proposals=tuple(
        Proposal(place=("spool",), equation="", effect=term, beside=("sensor_lag", "null_bias")) for term in TERMS
    ),
    settings={"custom": [OWN]},
)
FIT = Settings(effects=("sensor_lag",))


@pytest.mark.parametrize(
    ("name", "effects", "defined"),
    [
        ("dead_zone", ("dead_zone",), ()),
        ("overlap", ("overlap",), ("overlap",)),
        ("proposed_2", ("null_bias", "proposed_2"), ("proposed_2",)),
        ("proposed_3", ("null_bias", "proposed_2", "proposed_3"), ("proposed_2", "proposed_3")),
    ],
)
def test_each_name_is_added_with_what_it_stands_on(name, effects, defined):
    """Of the effects beside which a term was found those are added that the fit has not."""
    settings = with_named(FIT, (name,), diagnosis=FOUND)
    assert settings.effects == ("sensor_lag", *effects)
    assert tuple(one["name"] for one in settings.custom) == defined


def test_every_name_that_it_gives_is_one_of_them():
    assert list(names(FOUND)) == ["dead_zone", "overlap", "proposed_2", "proposed_3"]


def test_what_is_kept_is_asked_for_only_where_a_name_is_not_known_otherwise():
    """A file that cannot be read does not stand in the way of an effect of the catalogue."""

    def broken() -> dict[str, object]:
        raise Unusable("not-an-effect", "a file cannot be read", "effects", "remove it")

    assert with_named(FIT, ("dead_zone",), kept=broken).effects == ("sensor_lag", "dead_zone")
    assert with_named(FIT, ("overlap",), kept=lambda: {"overlap": OWN}).custom == (OWN,)
    with pytest.raises(Unusable, match="cannot be read"):
        with_named(FIT, ("overlap",), kept=broken)


@pytest.mark.parametrize(
    ("misspelt", "meant"),
    [("deadzone", "dead_zone"), ("overlp", "overlap"), ("proposed3", "proposed_3"), ("kept-bend", "kept_bend")],
)
def test_a_misspelt_name_is_answered_with_the_nearest(misspelt, meant):
    """Of the catalogue, of a definition, of the diagnosis, of what is kept."""
    with pytest.raises(Unusable, match=f"did you mean {meant}\\?"):
        with_named(FIT, (misspelt,), diagnosis=FOUND, kept=lambda: {"kept_bend": OWN})


def test_what_the_fit_has_is_not_added_again():
    with pytest.raises(Unusable, match="has sensor_lag already"):
        with_named(FIT, ("sensor_lag",))
