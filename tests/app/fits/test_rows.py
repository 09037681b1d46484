"""A fit's numbers become rows of text without losing what they say."""

from __future__ import annotations

from dataclasses import replace
from xml.dom.minidom import parseString

from app.fits.rows import combination_rows, error_rows, parameter_rows
from ident.fit.result import Combination, Estimate, FitResult, RunError, Undetermined, Window


def fit() -> FitResult:
    return FitResult(
        model="qian2014",
        effects=(),
        correlation={},
        method="ga",
        seed=0,
        evaluations=1,
        seconds=1.0,
        version="0",
        parameters={
            "Z0/A^2": Estimate(37.645, "1/s", 0.14, 0.13, 13128.0, False, "Z₀", "gain"),
            "m0": Estimate(1.0, "kg", None, 1.0, 1.0, False, "m₀", "mass", fixed=True),
            "Ka": Estimate(2e-13, "m^3/Pa", 1e-16, 2e-15, 2e-13, True, "Kₐ", "oil"),
        },
        determined=(
            Combination("Ka*tau*m0 / (A^2 + Cl*c0)", 2.778e-8, "s^3", 1.1e-9),
            Combination("a ? b", 1.0, "1", 0.1),
        ),
        undetermined=(Undetermined("m0", "by convention"),),
        error={"fit": 0.0407, "held_out": None, "verify": 0.037},
        offset={"fit": -0.01, "verify": 0.0},
        noise_floor={"fit": 0.02, "verify": None},
        runs=(RunError("a", "fit", 0.0407, -0.01),),
        data_hash="0",
    )


def test_a_parameter_is_printed_to_two_digits_of_its_standard_error_in_a_readable_unit():
    ratio, mass, oil = parameter_rows(fit())
    assert (ratio.symbol, ratio.value, ratio.std_error, ratio.unit) == ("Z₀/A²", "37.65", "0.14", "1/s")
    assert (oil.value, oil.std_error, oil.unit, oil.upper) == ("200.00", "0.10", "10⁻¹⁵ m³/Pa", "200")
    assert mass.std_error == "–"


def test_what_limits_a_parameter_is_said_beside_it():
    _, mass, oil = parameter_rows(fit())
    assert mass.remark == "fixed; not identifiable from these data"
    assert oil.remark == "at its bound"


def test_errors_stand_beside_their_noise_floor():
    fitted, verified = error_rows(fit())
    assert (fitted.error, fitted.floor, fitted.ratio, fitted.offset) == ("4.07 %", "2.00 %", "2.04 ×", "−1.0 %")
    assert (verified.error, verified.floor, verified.ratio) == ("3.70 %", "unknown", "–")


def test_a_combination_is_mathematics_and_what_is_none_is_escaped_text():
    formula, odd = combination_rows(fit())
    assert parseString(str(formula.expression)).getElementsByTagName("mfrac")
    assert str(odd.expression) == "a ? b"
    assert formula.relative == "4.0 %"


def test_errors_over_windows_stand_below_those_of_the_free_run():
    rows = error_rows(replace(fit(), window=Window(0.85, {"fit": 0.078, "held_out": None, "verify": 0.054})))
    length = "0.85 s"
    assert [row.use for row in rows] == [
        "estimation",
        "validation",
        f"estimation over {length}",
        f"validation over {length}",
    ]
    assert [row.error for row in rows[2:]] == ["7.80 %", "5.40 %"]
    assert (rows[2].ratio, rows[2].offset) == ("3.90 ×", "–")


def test_a_value_with_an_error_of_more_than_ten_times_itself_is_not_determined_on_page_and_terminal():
    lost = Estimate(35e-12, "m", 15023e-12, -1e-6, 1e-6, False, "s", "strength")
    (row,) = parameter_rows(replace(fit(), parameters={"own.s": lost}))
    assert (row.value, row.std_error, row.relative) == ("not identifiable", "15023", "–")
    assert "not identifiable" in str(replace(fit(), parameters={"own.s": lost}))
