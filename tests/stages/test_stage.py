"""A stage brings its parameters, each with the range that it is searched over, and says what it reads."""

from __future__ import annotations

import pytest

from ident.errors import Unusable
from ident.parameter import Parameter
from ident.stages import COMPRESSIBLE, PROPORTIONAL, Quantity, Scale
from ident.stages.bench import PLAY
from ident.stages.scale import in_reading_order
from ident.stages.stage import stage

LAG = Parameter("T", "T", "s", 1e-3, 1.0, 0.1, "time constant")


@pytest.mark.parametrize(("parameters", "scales"), [((LAG,), ()), ((), (Scale.by_bounds(LAG),))])
def test_a_parameter_without_a_scale_or_a_scale_without_a_parameter_is_refused(parameters, scales):
    with pytest.raises(Unusable, match="give each parameter one scale") as refused:
        stage("load", (Quantity("x", "m", "position"),), ("x' = u / T", ""), parameters=parameters, scales=scales)
    assert refused.value.where == "stage 'load'"


def test_a_stage_reads_what_it_neither_defines_nor_brings():
    """Of a memory the value before the step is its own, too."""
    assert COMPRESSIBLE.reads == {"Q", "A", "v"}
    assert PROPORTIONAL.reads == {"u", "du", "y_fb", "v_fb", "Kp"}
    assert PLAY.reads == {"q"}


def named(*texts: str) -> tuple[Scale, ...]:
    return tuple(Scale(name, text, 0.1, 10.0) for name, _, text in (text.partition("=") for text in texts))


def names(scales: tuple[Scale, ...]) -> str:
    return "".join(scale.name for scale in scales)


def test_scales_that_read_nothing_behind_them_stay_as_they_stand():
    assert names(in_reading_order(named("c=W", "b=c", "a=1", "d=a*b"))) == "cbad"


def test_a_scale_is_put_behind_those_that_it_reads():
    assert names(in_reading_order(named("a=b*c", "d=1", "c=W", "b=c"))) == "cbad"


@pytest.mark.parametrize(
    ("texts", "circle"), [(("a=a",), "a → a"), (("d=1", "e=a", "a=b", "b=d*c", "c=a*X"), "a → b → c → a")]
)
def test_scales_that_read_each_other_in_a_circle_are_refused(texts, circle):
    with pytest.raises(Unusable, match=f": {circle}: each is measured by the next"):
        in_reading_order(named(*texts))
