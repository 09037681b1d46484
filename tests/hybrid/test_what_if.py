"""A change of size or specimen, against the loop written out as polynomials: oil_column_reference.py."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from ident.errors import Unusable
from ident.figures.render import render
from ident.figures.root_locus import root_locus
from ident.figures.theme import look
from ident.figures.what_if_response import what_if_response
from ident.fit.bulk_modulus import bulk_modulus, oil_volume, with_bulk_modulus
from ident.fit.result import Estimate, FitResult
from ident.hybrid.changed_machine import Change, changed_machine
from ident.hybrid.oil_column import AS_GOOD, find_peak
from ident.hybrid.qian_figure_19 import PRINTED
from ident.hybrid.what_if import what_if
from ident.matrix import Actuator
from ident.run import Specimen
from tests.reference import oil_column_reference as reference

UNITS = {"Z0": "m^4/s", "tau": "s", "Cl": "m^3/(s*Pa)", "c0": "N*s/m", "m0": "kg", "Ka": "m^3/Pa"}
SMALL = Change(
    sizes={"area": reference.SMALL_AREA, "stroke": reference.SMALL_STROKE},
    specimen=Specimen(reference.MASS, reference.STIFFNESS),
)
AXES = {2.0: (0.5, 1.0), 3.0: (0.5, 2.0)}
WIDER = {gain: (0.9 * lower, 1.1 * upper) for gain, (lower, upper) in AXES.items()}


def fit_of(values=reference.TABLE_4, **stated) -> FitResult:
    """A fit that found these values, each with a standard error of 1 %."""
    return FitResult(
        model="qian2014",
        effects=(),
        parameters={n: Estimate(v, UNITS[n], 0.01 * v, v / 10, v * 10, at_bound=False) for n, v in values.items()},
        correlation={},
        determined=(),
        undetermined=(),
        error={},
        offset={},
        noise_floor={},
        runs=(),
        method="ga",
        seed=0,
        evaluations=0,
        seconds=0.0,
        version="0",
        data_hash="",
        actuator=Actuator("A", **({"piston_area": reference.AREA, "stroke": reference.STROKE} | stated)),
    )


@pytest.fixture(scope="module")
def small():
    """Table 4 scaled to the smaller cylinder, at gains 2 and 3."""
    return what_if(fit_of(), SMALL, (2.0, 3.0))


def test_table_4_scaled_has_no_peak_and_the_poles_of_the_closed_form(small):
    """Poles at −59.5 ± 67.7i Hz at gain 2, |G| at 45 Hz 0.075 and 0.117, nothing that bends up below 100 Hz."""
    for each, printed in zip(small.responses, (0.075, 0.117), strict=True):
        expected = sorted(reference.poles(reference.scaled(), each.gain), key=lambda p: (p.real, -p.imag))
        got = [complex(p.real, p.imaginary) for p in each.poles]
        assert np.allclose(got, expected, rtol=1e-9)
        curve = reference.magnitude(reference.scaled(), each.gain, each.frequency)
        assert np.allclose(each.magnitude, curve, rtol=1e-9)
        at = float(np.interp(45.0, each.frequency, each.magnitude))
        assert at == pytest.approx(printed, abs=5e-4)
        assert each.stable
        assert not each.peaks
        assert not len(reference.tops(reference.scaled(), each.gain))
    fastest = small.responses[0].poles[0]
    assert (round(fastest.real, 1), round(fastest.imaginary, 1)) == (-59.5, 67.7)


def test_it_is_said_that_fig_19_does_not_follow_from_table_4(small):
    """Only of that actuator and specimen, and of Table 4 only where the fit found its values."""
    assert any("Fig. 19" in note and "does not follow from Table 4" in note for note in small.notes)
    other = fit_of(reference.TABLE_4 | {"tau": 1.5 * reference.TABLE_4["tau"]})
    assert any("Fig. 19" in note and "these values" in note for note in what_if(other, SMALL, (2.0, 3.0)).notes)
    elsewhere = what_if(fit_of(), replace(SMALL, specimen=Specimen(5.0, 30.65e3)), (2.0, 3.0))
    assert not any("Fig. 19" in note for note in elsewhere.notes)


def test_stability_is_lost_where_the_closed_form_loses_it(small):
    """Below the critical gain every pole of the polynomial settles, above it one does not; its rows make the locus."""
    critical = small.critical_gain
    assert reference.poles(reference.scaled(), 0.999 * critical).real.max() < 0
    assert reference.poles(reference.scaled(), 1.001 * critical).real.max() > 0
    for gain, row in list(zip(small.locus.gain, small.locus.poles, strict=True))[::20]:
        got = np.sort_complex([complex(p.real, p.imaginary) for p in row])
        assert np.allclose(got, np.sort_complex(reference.poles(reference.scaled(), gain)), rtol=1e-8)


@pytest.fixture(scope="module")
def inside_wider():
    """The search for the peak of Fig. 19 inside axes that are widened by 10 %; another seed may be given."""
    target = replace(PRINTED, axes=PRINTED.widened(0.1))
    return find_peak(changed_machine(fit_of(), SMALL), target, seed=0, starts=3)


def test_no_single_parameter_makes_the_peak_of_fig_19():
    """Neither of the six, times 0.01 to times 100, inside the printed axes; judged by the polynomials as well."""
    for name, value in reference.scaled().items():
        factors = np.geomspace(0.01, 100, 121)
        assert not any(reference.shows_peak(reference.scaled() | {name: value * f}, AXES) for f in factors), name
    found = find_peak(changed_machine(fit_of(), SMALL), PRINTED, starts=0)
    assert found.singles == dict.fromkeys(reference.TABLE_4)
    assert "No single one" in found.text[0]


def test_the_smallest_joint_change_is_found_and_called_one_of_many(inside_wider):
    """√Σ (ln factor)² is at most 1.7, and the polynomials show the peak for it and at both ends of every range."""
    best = inside_wider.smallest
    assert best.size <= 1.7
    assert best.size == pytest.approx(np.linalg.norm(np.log(list(best.factors.values()))))
    ends = [end for r in inside_wider.others.values() for end in (r.at_lower, r.at_upper)]
    for change in (best, *ends):
        values = {name: value * change.factors[name] for name, value in reference.scaled().items()}
        assert reference.shows_peak(values, WIDER)
        assert best.size <= change.size <= AS_GOOD * best.size * (1 + 1e-5)
    assert set(inside_wider.others) == set(reference.TABLE_4)
    for name, span in inside_wider.others.items():
        assert span.lower < best.factors[name] < span.upper, name
    assert "one of many" in inside_wider.text[-1]


def test_a_change_known_beforehand_is_not_smaller(inside_wider):
    """c0 × 0.32, tau × 0.58, m0 × 1.65, Z0 × 1.6, Cl × 0.46, Ka × 1.16 does it too, and is larger."""
    known = {"c0": 0.32, "tau": 0.58, "m0": 1.65, "Z0": 1.6, "Cl": 0.46, "Ka": 1.16}
    values = {name: value * known[name] for name, value in reference.scaled().items()}
    assert reference.shows_peak(values, WIDER)
    assert inside_wider.smallest.size <= np.linalg.norm(np.log(list(known.values())))


def test_what_has_a_peak_already_needs_no_change():
    """A lightly damped machine is not changed for a peak where it has one."""
    values = reference.TABLE_4 | {"c0": 300.0, "Cl": 1e-12}
    machine = changed_machine(fit_of(values), Change(specimen=Specimen(2.06, 30.65e3)))
    own = what_if(fit_of(values), Change(specimen=Specimen(2.06, 30.65e3)), (2.0, 2.0)).responses[0].peaks
    assert own
    target = replace(PRINTED, frequency=own[0].frequency, gains=(2.0,), axes=(), up_to=0.0)
    found = find_peak(machine, target)
    assert found.already
    assert found.smallest is None


def test_a_bulk_modulus_stands_on_the_volume_that_is_stated():
    """V/(4 Ka) with the standard error of Ka: 1.36e8 Pa by area × stroke, eight times that with the printed volume."""
    by_stroke, stated = fit_of().actuator, replace(fit_of().actuator, volume=6e-4)
    small, printed = (bulk_modulus(fit_of().parameters, actuator) for actuator in (by_stroke, stated))
    assert small.value == pytest.approx(1.362e8, rel=1e-3)
    assert small.std_error == pytest.approx(0.01 * small.value)
    assert "area × stroke" in small.note
    assert printed.value == pytest.approx(1.079e9, rel=1e-3)
    assert oil_volume(Actuator("A", piston_area=1e-3)) is None
    kept = with_bulk_modulus(fit_of())
    assert kept.determined[-1].unit == "Pa"
    assert any("Bulk modulus" in note for note in kept.notes)
    assert with_bulk_modulus(fit_of(stroke=None)) == fit_of(stroke=None)


def test_a_volume_takes_the_place_of_area_and_stroke():
    """Ka goes with a volume that is named; a stated one goes with area × stroke otherwise, so that β is kept."""
    fit = fit_of(volume=1e-4)
    named = what_if(fit, Change(sizes={"area": 239e-6, "volume": 2e-4}))
    assert named.parameters["Ka"].after == pytest.approx(2 * reference.TABLE_4["Ka"])
    assert named.parameters["Z0"].after == pytest.approx(reference.TABLE_4["Z0"] * 239 / 497)
    both = what_if(fit, SMALL)
    assert both.actuator.volume == pytest.approx(1e-4 * 239 / 497 * 4 / 6)
    assert both.bulk_modulus.value == pytest.approx(bulk_modulus(fit.parameters, fit.actuator).value)
    set_ = what_if(fit, replace(SMALL, values={"Ka": 1e-13}))
    assert (set_.parameters["Ka"].after, set_.bulk_modulus.std_error) == (1e-13, None)


@pytest.mark.parametrize(
    ("change", "gains", "code"),
    [
        (Change(sizes={"volume": 1e-4}), None, "missing-size"),
        (Change(sizes={"area": -1.0}), None, "bad-size"),
        (Change(values={"nothing": 1.0}), None, "unknown-parameter"),
        (Change(values={"Z0": -1e-6}), None, "bad-number"),
        (Change(known={"area": 5e-4}), None, "two-sizes"),
        (Change(), (3.0, 2.0), "bad-gain"),
    ],
)
def test_what_cannot_be_changed_is_refused(change, gains, code):
    with pytest.raises(Unusable) as refused:
        what_if(fit_of(), change, gains)
    assert refused.value.code == code


def test_an_effect_without_a_linear_response_is_left_out_and_said():
    """A dead zone hangs on the amplitude; integral action does not, and adds a pole."""
    fit = fit_of()
    extra = {"dead_zone.half_width": Estimate(1e-4, "m", None, 0, 1e-3, at_bound=False)}
    dead = replace(fit, effects=("dead_zone",), parameters={**fit.parameters, **extra})
    found = what_if(dead, SMALL, (2.0, 3.0))
    assert any("Not in the response" in note and "dead_zone" in note for note in found.notes)
    assert found.responses[0].poles == what_if(fit, SMALL, (2.0, 3.0)).responses[0].poles
    extra = {"integral_action.gain": Estimate(5.0, "1/s", None, 0, 50, at_bound=False)}
    more = what_if(
        replace(fit, effects=("integral_action",), parameters={**fit.parameters, **extra}), SMALL, (2.0, 3.0)
    )
    assert len(more.responses[0].poles) == 5
    assert not any("Not in the response" in note for note in more.notes)


@pytest.mark.full
def test_figures_are_drawn_in_both_themes(small):
    """Response and root locus, from the result alone."""
    for theme, format_ in (("light", "svg"), ("dark", "json")):
        assert b"Kp = 2" in render(what_if_response(small, look(theme)), format_)
        assert b"stability is lost" in render(root_locus(small, look(theme)), format_)


def test_the_command_takes_a_spread_by_hand_and_from_a_file(servoident, tmp_path):
    """As `servoident query --json` writes sets; a file without sets is refused."""
    fit, sets = tmp_path / "fit.json", tmp_path / "sets.json"
    fit.write_text(json.dumps(fit_of().to_json()))
    known = [{"model": "qian2014", "parameters": {"Z0": {"value": value}}} for value in (2.5e-6, 2.6e-6, 2.8e-6)]
    sets.write_text(json.dumps(known))
    for given, said in (("10 %", "± 10 % of each parameter"), (sets, "3 parameter sets of sets.json")):
        done = servoident("whatif", fit, "--gain", "2:3", "--spread", given)
        assert said in " ".join(done.stdout.split())
    sets.write_text("{}")
    assert servoident("whatif", fit, "--gain", "2:3", "--spread", sets).returncode == 2


def test_the_command_says_unstable_by_its_status_and_json(servoident, tmp_path):
    """Table 4 loses stability at Kp = 56.9: the gain is the cause, and the mark on the root locus says where."""
    import json

    file = tmp_path / "fit.json"
    file.write_text(json.dumps(fit_of().to_json()))
    done = servoident("whatif", file, "--gain", "70", "--before-gain", "8", "--json", "-")
    assert done.returncode == 1, done.stderr
    found = json.loads(done.stdout)
    assert found["state"] == found["stability"][0]["state"] == "unstable"
    assert [one["name"] for one in found["stability"][0]["causes"]] == ["Kp"]
    assert found["locus"]["marks"][0]["gain"] == found["critical_gain"] == pytest.approx(56.86, abs=0.01)


def test_the_command_chooses_a_gain(servoident, tmp_path):
    """The value may have its unit; the response is that at the chosen gain."""
    import json

    file = tmp_path / "fit.json"
    file.write_text(json.dumps(fit_of().to_json()))
    done = servoident("whatif", file, "--choose", "gain_margin=6 dB", "--json", "-")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["responses"][0]["gain"] == found["chosen"]["gain"] == pytest.approx(56.86 / 10**0.3, rel=1e-3)
    assert found["chosen"]["reached"]


def test_a_delay_that_the_fit_has_not_is_added(servoident, tmp_path):
    """Stable without it; the command names the effect's parameter, and the delay is the cause."""
    import json

    file = tmp_path / "fit.json"
    file.write_text(json.dumps(fit_of().to_json()))
    done = servoident("whatif", file, "--gain", "20", "--set", "loop_delay.delay=6 ms")
    assert done.returncode == 1, done.stderr
    assert "The cause is the delay" in done.stdout


def test_the_command_writes_json_and_figures(servoident, tmp_path):
    """The case of Fig. 19, from a fit's file, with units; a size that is not known is refused in one line."""
    import json

    file, out = tmp_path / "fit.json", tmp_path / "figures"
    file.write_text(json.dumps(fit_of(stroke=None).to_json()))
    given = (
        "whatif",
        file,
        "--set",
        "area=239 mm^2",
        "--set",
        "stroke=4 in",
        "--gain",
        "2:3",
        "--specimen",
        "mass=2.06 kg, stiffness=30.65 kN/m",
    )
    refused = servoident(*given)
    assert refused.returncode == 2
    assert len(refused.stderr.strip().splitlines()) == 1
    done = servoident(*given, "--fitted", "stroke=6 in", "--json", tmp_path / "w.json", "--out", out)
    assert done.returncode == 0, done.stderr
    assert "does not follow from Table 4" in done.stdout
    data = json.loads((tmp_path / "w.json").read_text())
    assert [each["gain"] for each in data["responses"]] == [2.0, 3.0]
    assert {path.name for path in out.iterdir()} >= {"response.svg", "root-locus.pdf"}
