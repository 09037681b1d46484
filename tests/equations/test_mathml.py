"""Equations as they are read: what belongs together is seen to."""

from __future__ import annotations

import pytest

from ident.equations.mathml import mathml

OPEN, CLOSE = "<mrow><mo>(</mo>", "<mo>)</mo></mrow>"
X_OVER_D = "<mfrac><mrow><mi>x</mi></mrow><mrow><mi>d</mi></mrow></mfrac>"


@pytest.mark.parametrize(
    ("text", "drawn"),
    [
        ("F = (x/d)**2", f"<msup>{OPEN}{X_OVER_D}{CLOSE}<mrow><mn>2</mn></mrow></msup>"),
        ("F = delay(x/d, 0.1)", f"{OPEN}{X_OVER_D}{CLOSE}<mo>⁡</mo>"),
        ("F = (x + d)**2", f"<msup>{OPEN}<mrow><mi>x</mi></mrow><mo>+</mo><mrow><mi>d</mi></mrow>{CLOSE}"),
        ("F = x**2", "<msup><mrow><mi>x</mi></mrow><mrow><mn>2</mn></mrow></msup>"),
        ("F = sin(2 * pi * f)", "<mrow><mn>2</mn></mrow><mo>·</mo><mrow><mi>π</mi></mrow>"),
        ("F = 3.14 * x", "<mn>3.14</mn>"),
        ("F = 3*(x/d)", f"<mrow><mn>3</mn></mrow><mo>·</mo><mrow>{X_OVER_D}</mrow>"),
    ],
)
def test_brackets_stand_where_a_reader_needs_them_and_only_there(text, drawn):
    assert drawn in mathml(text)


def test_a_curve_is_written_with_its_signal():
    """A symbol that stands for a curve says what it is a curve of; others with the same letter are left."""
    found = mathml("flow = s * (h * P + h0)", {"h": "P"})
    assert "<mi>h</mi><mo>⁡</mo><mrow><mo>(</mo><mi>P</mi><mo>)</mo></mrow>" in found
    assert "<msub><mi>h</mi><mi>0</mi></msub>" in found


def test_a_word_is_no_letter_with_an_index():
    assert mathml("flow = Ka * force_max").count("<mi>flow</mi>") == 1
    assert "<msub><mi>K</mi><mi>a</mi></msub>" in mathml("flow = Ka * x")
    assert "<msub><mi>force</mi><mi>max</mi></msub>" in mathml("flow = Ka * force_max")
