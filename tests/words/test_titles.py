"""Names of the program as a reader reads them."""

from __future__ import annotations

from ident.words.titles import of_parameter, title, with_effects


def test_names_are_words():
    assert title("dead_zone") == "dead zone"
    assert with_effects("Qian 2014", ["dead_zone", "coulomb_friction"]) == "Qian 2014 + dead zone + Coulomb friction"
    assert with_effects("Qian 2014", []) == "Qian 2014"


def test_the_parameter_of_an_effect_says_whose_it_is():
    assert of_parameter("dead_zone.half_width", "half of it") == "dead zone: half of it"
    assert of_parameter("tau", "the delay") == "the delay"
