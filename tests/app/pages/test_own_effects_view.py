"""What a proposed term is called, and who can take an effect that is kept."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.own_effects.own_effect import OwnEffect, suggested, usable_on, view, written_down
from app.pages.own_effects_view import kept_rows
from tests.app.test_custom_effects import OWN


@pytest.mark.parametrize(
    ("meaning", "name"),
    [
        ("leakage in one direction: the leak differs with the sign", "leakage_in_one_direction"),
        ("a spring that hardens or softens", "spring_that_hardens_or_softens"),
        ("a term at the flow and load", "term_at_the_flow_and_load"),
        ("Dead zone", "dead_zone_2"),
        ("Q", "q_2"),
        ("3 notches", "term_3_notches"),
        ("ü", "own"),
        ("kept", "kept_3"),
        ("x" * 100, "x" * 40),
    ],
)
def test_a_name_is_suggested_that_is_free_and_can_be_read(meaning, name):
    """Neither an effect of the catalogue nor a symbol, nor one of those that are kept."""
    assert suggested(meaning, {"kept", "kept_2"}) == name
    assert written_down(OWN, name).name == name


def test_another_model_takes_it_where_it_counts_in_the_same_units():
    """A valve counts in metres of its drive signal, a bench's in rated currents."""
    any_, of_one, of_bench = (written_down(OWN, "lapped", model=model) for model in ("", "qian2014", "kononykhin"))
    assert list(usable_on([any_, of_one, of_bench], "qian2014")) == [any_, of_one]
    assert list(usable_on([any_, of_one, of_bench], "open_valve")) == [any_, of_one]
    assert list(usable_on([any_, of_one, of_bench], "kononykhin")) == [any_, of_bench]
    assert list(usable_on([any_, of_one, of_bench], "specimen")) == []


def test_what_this_version_cannot_read_is_listed_with_the_reason():
    """A later catalogue may have an effect of the name."""
    kept = OwnEffect(name="dead_zone", definition=OWN | {"name": "dead_zone"}, meaning="of an earlier version")
    assert "the effect library has an effect dead_zone" in view(kept).refused
    (row,) = kept_rows([kept])
    assert (row.title, row.meaning, row.equations) == ("dead zone", "of an earlier version", ())
    assert "the effect library has" in row.refused
    assert not kept.suits("qian2014")
    assert not view(replace(kept, name="lapped", definition=OWN | {"name": "lapped"})).refused
