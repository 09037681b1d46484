"""The nearest name to a misspelt one."""

from __future__ import annotations

import pytest

from ident.effects import CATALOGUE, effect
from ident.errors import Unusable
from ident.fit.choices import settings_of
from ident.fit.identification import check_settings
from ident.words.nearest import did_you_mean, nearest


@pytest.mark.parametrize(
    ("misspelt", "known", "meant"),
    [
        ("deadzone", ("dead_zone", "lead"), "dead_zone"),
        ("Dead Zone", ("dead_zone", "lead"), "dead_zone"),
        ("KP", ("Ka", "Kp"), "Kp"),
        ("tua", ("Z0", "tau", "T"), "tau"),
        ("Z1", ("Z0", "tau"), "Z0"),
        ("magic", ("dead_zone", "lead"), None),
        ("", ("dead_zone",), None),
        ("__", ("dead_zone",), None),
        ("x", (), None),
    ],
)
def test_neither_case_nor_separators_count(misspelt, known, meant):
    """A slip of a letter or two is near; of a name of up to three letters one."""
    assert nearest(misspelt, known) == meant


def test_a_name_that_could_be_read_as_a_word_of_the_sentence_is_in_quotes():
    assert did_you_mean("IN", ("in", "ft")) == "did you mean 'in'?"
    assert did_you_mean("inches", ("inch", "ft")) == "did you mean inch?"
    assert did_you_mean("dead zon", ("dead zone",)) == "did you mean 'dead zone'?"


def test_where_none_is_near_the_names_are_listed_or_a_remedy_is_given():
    assert did_you_mean("magic", ("a", "b")) == "choose from a, b"
    assert did_you_mean("magic", ("a", "b"), "look there") == "look there"
    assert did_you_mean("magic", ()) == "leave it out"


def test_what_is_no_text_is_answered_too():
    """As of a library's call with a number for a name."""
    assert did_you_mean(5, ("none", "force")) == "choose from none, force"
    with pytest.raises(Unusable, match="choose from none, force"):
        check_settings(settings_of({"load": 5}))


def test_all_names_that_contain_the_given_word_are_said():
    """Of which there may be several; one letter is no word."""
    known = ("load_pressure", "pressure_a", "spool", "a")
    assert did_you_mean("Pressure", known) == "did you mean load_pressure or pressure_a?"
    assert did_you_mean("presure_a", known) == "did you mean pressure_a?"


def test_a_name_with_spaces_stands_in_quotes():
    assert did_you_mean("Weg [m]", ("Weg [mm]", "Zeit")) == "did you mean 'Weg [mm]'?"


@pytest.mark.parametrize("name", [known.name for known in CATALOGUE])
def test_every_effect_is_found_without_a_letter_and_with_two_exchanged(name):
    """The first of the slips that the catalogue's own names do not take for another one."""
    for slip in (name[:-1], name[:-2] + name[-1] + name[-2], name.replace("_", "")):
        if slip != name:
            with pytest.raises(Unusable, match=f"did you mean {name}\\?"):
                effect(slip)
