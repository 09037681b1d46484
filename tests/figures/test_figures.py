"""Every figure, in every format and theme, says what it shows, with units, and stays small."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
import vl_convert
from altair.utils import schemapi

import ident.figures.study
from ident.comparison.compare import Comparison
from ident.errors import Unusable
from ident.figures import FIGURES, MEDIA, figure, render, renders
from ident.figures.residual_map import residual_map
from ident.figures.study import Study
from ident.figures.theme import LOOKS
from ident.fit.result import Starts
from ident.workflows import study
from tests.figures.conftest import make_comparison
from tests.short_form import short_form

OF_CHAINS = tuple(name for name, drawing in FIGURES.items() if drawing.kind == "chain")
DRAWN: dict[tuple[object, ...], bytes] = {}
STUDIED: list[Study] = []


@pytest.fixture(autouse=True)
def hand_made(monkeypatch: pytest.MonkeyPatch) -> None:
    """Responses in closed form instead of the compared fit."""

    def compare(matrix, fit, _simulator):
        return Comparison(matrix, fit, tuple(map(make_comparison, matrix.runs)))

    monkeypatch.setattr(ident.figures.study, "compare", compare)


def drawn(name, matrix, fit, theme="light", **options):
    """A figure of the one matrix and fit of these tests, drawn once for all that look at it."""
    key = (name, theme, *sorted(options.items()))
    if key not in DRAWN:
        DRAWN[key] = render(figure(name, studied(matrix, fit), theme, **options), "json")
    return json.loads(DRAWN[key])


def studied(matrix, fit):
    """What figures take from the data of these tests, worked out once for all of them, as a page does."""
    if not STUDIED:
        STUDIED.append(study(matrix, fit))
    assert STUDIED[0].fit is fit
    return STUDIED[0]


def every(spec, key):
    """All values under a key, anywhere in the specification but its data."""
    if isinstance(spec, dict):
        for name, value in spec.items():
            if name == key:
                yield value
            if name != "datasets":
                yield from every(value, key)
    elif isinstance(spec, list):
        for value in spec:
            yield from every(value, key)


def rows_of(spec):
    return [row for table in spec["datasets"].values() for row in table]


@pytest.mark.parametrize("name", OF_CHAINS)
@pytest.mark.parametrize("theme", LOOKS)
def test_every_figure_names_serial_model_and_error_and_is_below_300_kb(name, theme, matrix, fit, full):
    if theme != "light" and OF_CHAINS.index(name) % 3 and not full:
        pytest.skip("one of three in the other theme: run with --full")
    spec = drawn(name, matrix, fit, theme)
    assert spec["title"]["text"].startswith("SW-910D-0001")
    assert "qian2014" in spec["title"]["subtitle"][0]
    assert "0.512 % estimation, 0.507 % validation" in spec["title"]["subtitle"][0]
    assert spec["config"]["background"] == LOOKS[theme].ground
    assert len(json.dumps(spec)) < 300_000


@pytest.mark.parametrize("name", OF_CHAINS)
def test_every_named_axis_has_a_unit(name, matrix, fit):
    titles = [axis["title"] for axis in every(drawn(name, matrix, fit), "axis") if axis.get("title")]
    assert titles
    assert all("(" in title and title.endswith(")") for title in titles)


def test_a_figure_is_one_definition_in_four_formats_and_is_drawn_once_for_all(matrix, fit, monkeypatch):
    """Pixel by pixel what Vega-Lite's own converter makes of the definition."""
    drawings = []
    monkeypatch.setattr(vl_convert, "vegalite_to_svg", counted(vl_convert.vegalite_to_svg, drawings))
    found = renders(figure("evolution", study(matrix, fit)), tuple(MEDIA))
    starts = {"json": b"{", "svg": b"<svg", "png": b"\x89PNG\r\n\x1a\n", "pdf": b"%PDF-"}
    assert {kind: written.startswith(starts[kind]) for kind, written in found.items()} == dict.fromkeys(MEDIA, True)
    assert drawings == [found["json"].decode()]
    assert found["png"] == vl_convert.vegalite_to_png(found["json"].decode(), scale=2)


def counted(function, calls):
    """The function, which notes what it is first given."""

    def noting(first, **options):
        calls.append(first)
        return function(first, **options)

    return noting


def test_the_bode_plot_shows_a_few_verify_runs_and_says_of_how_many(matrix, fit):
    spec = drawn("bode", matrix, fit)
    shown = {row["r"] for row in rows_of(spec)}
    assert shown <= {run.id for run in matrix.of_use("verify")}
    assert 3 <= len(shown) <= 6
    assert f"{len(shown)} of 21 runs" in spec["title"]["subtitle"][1]


@pytest.mark.parametrize("name", short_form(OF_CHAINS, "bode"))
def test_a_caption_ends_where_a_figure_of_a_page_ends(name, matrix, fit):
    """A page draws figures at three quarters of their width, which hold 98 letters of a caption."""
    spec = drawn(name, matrix, fit, share=0.76)
    assert max(map(len, spec["title"]["subtitle"])) <= 98


@pytest.mark.full
def test_all_84_runs_become_one_column_a_gain_with_shared_scales(matrix, fit):
    spec = drawn("bode", matrix, fit, use="all")
    headings = [panel["title"]["text"] for panel in spec["concat"] if "title" in panel]
    assert headings == ["Kp 5", "Kp 6", "Kp 7", "Kp 10"]
    magnitudes = [panel["layer"][1]["encoding"]["y"]["scale"]["domain"] for panel in spec["concat"][:4]]
    assert all(domain == magnitudes[0] for domain in magnitudes)


def test_legend_entries_are_in_numeric_not_in_alphabetic_order(matrix, fit):
    spec = drawn("bode", matrix, fit, kp=10)
    (domain,) = {tuple(entry["scale"]["domain"]) for entry in every(spec, "color") if isinstance(entry, dict)}
    masses = [0.0 if entry == "no specimen" else float(entry.split()[0]) for entry in domain]
    assert masses == sorted(masses)
    assert list(domain) != sorted(domain)


def test_magnitude_is_in_decibels_and_phase_runs_on_below_180_degrees(matrix, fit):
    run = matrix.runs[0]
    spec = drawn("bode", matrix, fit, run=run.id)
    rows, points, lines = rows_of(spec), spec["datasets"]["gain0"], spec["datasets"]["lines0"]
    assert {row["r"] for row in rows} == {run.id}
    assert lines[0]["A"] == pytest.approx(0.0, abs=0.05)  # unit gain at the lowest frequency
    assert min(row["P"] for row in lines) < -200
    phase = np.interp([row["f"] for row in points], *zip(*((row["f"], row["P"]) for row in lines), strict=True))
    assert np.all(np.abs(np.array([row["p"] for row in points]) - phase) <= 181)
    assert max(row["f"] for row in rows) <= 81  # the excited band, not the Nyquist frequency


def test_points_without_coherence_fade(matrix, fit):
    spec = drawn("bode", matrix, fit)
    (opacity,) = {json.dumps(entry["scale"]) for entry in every(spec, "opacity") if isinstance(entry, dict)}
    low, high = json.loads(opacity)["range"]
    assert low < 0.1 < high


def test_filters_choose_by_gain_amplitude_and_specimen_and_say_when_nothing_passes(matrix, fit):
    rows = rows_of(drawn("bode", matrix, fit, kp="7", amplitude="0.00127", specimen="10.2 kg, 67.6 kN/m"))
    assert {row["r"] for row in rows} == {"m10.2-k67.6-kp7-a1.27"}
    with pytest.raises(Unusable, match="no run with kp"):
        figure("bode", study(matrix, fit), kp=8)


def test_a_time_figure_keeps_the_peaks_of_a_long_stretch(matrix, fit):
    run = matrix.runs[10]
    rows = rows_of(drawn("time", matrix, fit, run=run.id, start=0, seconds=2))
    measured = [row["y"] for row in rows if row.get("s") == "measured"]
    assert len(measured) < run.length
    assert max(measured) == pytest.approx(1000 * run.measured.max(), rel=1e-4)
    assert min(measured) == pytest.approx(1000 * run.measured.min(), rel=1e-4)


def test_the_residual_below_is_measured_minus_model_on_its_own_scale(matrix, fit):
    run = matrix.runs[10]
    spec = drawn("time", matrix, fit, run=run.id, start=0.5, seconds=0.1)
    residual = run.measured - make_comparison(run).modelled
    at = {row["t"]: row["y"] for row in spec["datasets"]["residual"]}
    titles = [axis.get("title") for axis in every(spec, "title") if isinstance(axis, dict)]
    titles += [title for title in every(spec, "title") if isinstance(title, str)]
    scale = 1e6 if "Measured − model (µm)" in titles else 1e3
    for time, value in list(at.items())[:10]:
        assert value == pytest.approx(scale * residual[round(time * run.sample_rate)], rel=1e-3, abs=1e-3)


def test_a_stretch_outside_the_record_is_refused_with_the_record_s_length(matrix, fit):
    with pytest.raises(Unusable, match="stay within 0 to 2"):
        figure("time", study(matrix, fit), start=3)


def test_evolution_shows_generations_1_4_8_and_last_on_the_bounds_with_the_paper_s_axes(matrix, fit):
    spec = drawn("evolution", matrix, fit)
    panels = spec["vconcat"][0]["hconcat"]
    assert [panel["title"]["text"] for panel in panels] == [f"Generation {index}" for index in (1, 4, 8, 12)]
    x = panels[0]["layer"][0]["encoding"]["x"]
    assert x["axis"]["title"].startswith("Z0")
    assert x["scale"]["domain"] == pytest.approx([1.751, 3.503])
    assert (x["axis"]["labelOverlap"], x["axis"]["labelSeparation"]) == ("greedy", 6)
    assert (x["axis"]["format"], x["axis"]["labelBound"]) == ("~r", True)  # 20, not 2e+1; none reaches the next panel
    assert panels[0]["layer"][0]["encoding"]["color"]["legend"]["format"] == "~r"


def test_error_over_generation_is_in_percent(matrix, fit):
    spec = drawn("evolution", matrix, fit)
    best = [row["e"] for row in spec["datasets"]["history"] if row["s"] == "best"]
    assert best == pytest.approx([100 * generation.best for generation in fit.evolution], rel=1e-4)


def test_a_name_that_was_not_searched_is_refused_with_those_that_were(matrix, fit):
    with pytest.raises(Unusable, match="use Z0, c0"):
        figure("evolution", study(matrix, fit), x="tau")


def test_sensitivity_goes_from_a_tenth_to_ten_times_the_run_s_own_value(matrix, fit):
    spec = drawn("sensitivity", matrix, fit)
    assert set(spec["datasets"]) == {"mass", "stiffness", "gain"}
    multiples = sorted({row["x"] for row in spec["datasets"]["mass"]})
    assert multiples[0] == 0.1
    assert multiples[-1] == 10
    assert 1.0 in multiples


def test_a_gain_that_makes_the_loop_unstable_is_named_and_not_drawn(matrix, fit):
    spec = drawn("sensitivity", matrix, fit, run="m4.25-k17.5-kp6-a1.27")
    headings = [panel["title"]["subtitle"] for panel in spec["concat"] if "title" in panel]
    assert headings[2][1].startswith("unstable from")
    assert max(row["x"] for row in spec["datasets"]["gain"]) < 10


def test_a_heavier_specimen_lowers_the_curve_above_resonance(matrix, fit):
    rows = drawn("sensitivity", matrix, fit)["datasets"]["mass"]
    top = max(row["f"] for row in rows)
    at_top = {row["x"]: row["a"] for row in rows if row["f"] == top}
    assert at_top[10] < at_top[1] < at_top[0.1]


def test_a_run_without_specimen_has_a_gain_column_only(matrix, fit):
    spec = drawn("sensitivity", matrix, fit, run="m0-k0-kp6-a1.27")
    assert set(spec["datasets"]) == {"gain"}


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"name": "nyquist"}, "choose from residual-map, bode"),
        ({"name": "bode", "theme": "sepia"}, "choose from light, dark"),
        ({"name": "bode", "colour": "red"}, "no option 'colour'"),
        ({"name": "bode", "kp": "six"}, "give a number"),
        ({"name": "bode", "axis": "cubic"}, "choose from log, linear"),
        ({"name": "time", "start": "noon"}, "give a number"),
        ({"name": "evolution", "generations": "last"}, "give whole numbers"),
    ],
)
def test_what_cannot_be_drawn_is_refused_with_the_remedy(arguments, says, matrix, fit):
    arguments = dict(arguments)
    with pytest.raises(Unusable, match=says):
        figure(arguments.pop("name"), study(matrix, fit), **arguments)


def test_an_unknown_format_is_refused(matrix, fit):
    with pytest.raises(Unusable, match="choose from json, svg, png, pdf"):
        render(figure("evolution", study(matrix, fit)), "gif")


@pytest.mark.parametrize("name", ["bode", "time", "sensitivity"])
def test_drawn_live_two_runs_differ_in_data_and_parameters_only(name, matrix, fit):
    first, second = (
        json.loads(render(figure(name, study(matrix, fit), run=run), "json", live=True))
        for run in ("m0.87-k36.3-kp7-a1.27", "m2.1-k17.5-kp7-a1.27")
    )
    assert [param["name"] for param in first["params"]] == [param["name"] for param in second["params"]]
    assert first.pop("params") != second.pop("params")
    assert first.pop("datasets") != second.pop("datasets")
    assert first == second


def test_a_chart_that_is_written_does_not_turn_the_checks_on_for_one_that_is_drawn():
    """Altair has one switch for all threads: a page that asked for two figures at once got an error for one of them."""

    class Written:
        def to_json(self, **_options):
            return json.dumps({"checked": schemapi.DEBUG_MODE})

    assert json.loads(render(Written(), "json")) == {"checked": False}
    assert schemapi.DEBUG_MODE


def test_ends_are_drawn_in_the_order_of_their_errors_over_the_best(matrix, fit):
    tables = drawn("starts", matrix, fit)["datasets"]
    assert [row["e"] for row in tables["ends"]] == [0.5, 0.5, 2.0]
    assert [row["v"] for row in tables["values"] if row["p"] == "c0"] == [1.0, 1.0003, 0.28125]
    with pytest.raises(Unusable, match=r"no figure .starts."):
        figure("starts", study(matrix, replace(fit, starts=Starts(3, 2))))


def test_a_machine_that_is_moved_has_no_sensitivity_to_a_command_and_says_so(matrix, fit):
    """A specimen on a rig records its motion and its force, and no command: a comparison names what it leaves out."""
    bare = [replace(run, channels={"velocity": run.channels["displacement"]}) for run in matrix.runs]
    moved = study(replace(matrix, runs=tuple(bare)), fit)
    with pytest.raises(Unusable, match="moved by what was recorded") as told:
        figure("sensitivity", moved)
    assert told.value.code == "unstable-model"


@pytest.mark.parametrize("name", ["residual-spectrum", "residual-correlation"])
def test_a_residual_of_a_model_that_runs_away_is_not_drawn(name, matrix, fit):
    """Its samples are no numbers: the reader is told which run, and to choose another one."""
    away = study(matrix, fit)
    away.compared(matrix.runs)
    away._runs |= {name: replace(compared, unstable=True) for name, compared in away._runs.items()}
    with pytest.raises(Unusable, match="unstable on") as told:
        figure(name, away)
    assert told.value.code == "unstable-model"


def test_lags_are_a_whole_number(matrix, fit):
    with pytest.raises(Unusable, match=r"lags is 2\.7"):
        figure("residual-correlation", study(matrix, fit), lags="2.7")
    with pytest.raises(Unusable, match=r"lags is 0.*give 1 to 512"):
        figure("residual-correlation", study(matrix, fit), lags="0")


def test_the_map_is_in_multiples_of_the_noise_on_one_scale_of_colours(matrix, fit):
    """From noise alone, 1, to ten times at least; where the noise of a run is not known, in per cent."""
    spec = drawn("residual-map", matrix, fit)
    (scale,) = [one["scale"] for one in every(spec, "color") if isinstance(one, dict) and one.get("field") == "m"]
    assert scale["domain"][0] == 1
    assert scale["domain"][1] >= 10
    assert min(row["m"] for row in spec["datasets"]["map"]) >= 1
    compared = Comparison(matrix, fit, tuple(map(make_comparison, matrix.runs)))
    unknown = residual_map(compared, matrix.actuator, fit, LOOKS["light"], floors={})
    assert "the noise of a run is not known" in unknown.to_json(ensure_ascii=False)


def test_other_fits_are_drawn_over_the_first_in_a_colour_each(matrix, fit):
    """Up to eight in all; what was measured is drawn once."""
    held = replace(fit, parameters={**fit.parameters, "tau": replace(fit.parameters["tau"], fixed=True)})
    spec = drawn_anew("bode", matrix, fit, other=[held, fit])
    names = ["A: qian2014, 0.500 %", "B: qian2014, tau held, 0.500 %", "C: qian2014, 0.500 %"]
    assert {row["s"] for row in spec["datasets"]["lines0"]} == set(names)
    assert {row["s"] for row in spec["datasets"]["gain0"]} == {"measured"}
    spec = drawn_anew("time", matrix, fit, other=[held])
    assert {row["s"] for row in spec["datasets"]["residual"]} == set(names[:2])
    with pytest.raises(Unusable, match="give 7 others at most"):
        figure("step", study(matrix, fit), other=[fit] * 8)
    with pytest.raises(Unusable, match="give one fit or several"):
        figure("residual-spectrum", study(matrix, fit), other=["a"])


def drawn_anew(name, matrix, fit, **options):
    return json.loads(render(figure(name, study(matrix, fit), **options), "json"))
