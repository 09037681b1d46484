"""The residual of one run over frequency, of one fit or of several, against the noise."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import altair as alt

from ident.comparison.compare import RunComparison
from ident.figures import words
from ident.figures.drawing import Drawing, Options
from ident.figures.options import OTHER, RUN
from ident.figures.other_fits import others_of, titles_of
from ident.figures.render import Chart, datasets
from ident.figures.run_selection import selected_run, typical_run, unstable_on
from ident.figures.study import Study
from ident.figures.theme import Look
from ident.figures.thinning import decade_ticks
from ident.residuals.breakdown import band_edges, in_bands, noise_in_bands

_NOISE = "noise, spread evenly over frequency"


def residual_spectrum(
    compared: Mapping[str, RunComparison], floor: float | None, told: Sequence[str], headline: str, look: Look
) -> Chart:
    """The error in each band (%), a line a model, on two logarithmic axes; dashed the noise where its `floor` is known.

    `compared` has one run with each model. The squares of a line add up to the square of its error, eq. (17).
    """
    run = next(iter(compared.values())).run
    edges = band_edges([run])
    levels = {name: in_bands(one, edges) for name, one in compared.items()}
    if floor is not None:
        levels[_NOISE] = noise_in_bands(run, floor, edges)
    shown = [edges[1] ** 2 / edges[2] if len(edges) > 2 else edges[1] / 2, *edges[1:]]
    rows = [row for name, errors in levels.items() for row in _rows(name, shown, errors)]
    colours = [*look.series[: len(compared)], look.faint]
    legend = alt.Legend(orient="bottom", columns=1, labelLimit=560, symbolType="stroke")
    colour = alt.Color("s:N", title=None, scale=alt.Scale(domain=list(levels), range=colours), legend=legend)
    dashes = alt.Scale(domain=list(levels), range=[*([[1, 0]] * len(compared)), [5, 4]])
    dash = alt.StrokeDash("s:N", scale=dashes, legend=legend, title=None)
    unit = "Hz" if run.time_unit == "s" else "cycles/sample"
    x = alt.X(
        "f:Q",
        scale=alt.Scale(type="log", domain=[shown[0], shown[-1]], nice=False),
        axis=alt.Axis(title=f"Frequency ({unit})", values=decade_ticks(shown[0], shown[-1]), format="~r"),
    )  # fmt: skip
    lines = alt.Chart(alt.NamedData("bands")).mark_line(strokeWidth=1.7, interpolate="step-after").encode(
        x=x, y=alt.Y("e:Q", axis=alt.Axis(title="Residual in the band (%)"),
                     scale=alt.Scale(type="log", nice=False, padding=8)),
        color=colour, strokeDash=dash,
        tooltip=[alt.Tooltip("s:N", title="Model"), alt.Tooltip("f:Q", title=f"From ({unit})", format=".3g"),
                 alt.Tooltip("e:Q", title="Residual (%)", format=".3g")],
    )  # fmt: skip
    subtitle = words.wrapped([*told, f"last band: all above {edges[-2]:.3g} {unit}"], look)
    chart: Chart = alt.layer(
        lines,
        width=look.across(640),
        height=300,
        title=alt.TitleParams(headline, subtitle=subtitle),
        datasets=datasets({"bands": rows}),
    ).configure(**look.config())
    return chart


def _rows(name: str, edges: Sequence[float], errors: Sequence[float | None]) -> list[dict[str, Any]]:
    """A row an edge: the level up to the next one, and the last level once more."""
    levels = [None if not error else float(f"{100 * error:.4g}") for error in errors]
    ends = zip(edges, [*levels, levels[-1]], strict=True)
    return [{"f": float(f"{edge:.5g}"), "e": level, "s": name} for edge, level in ends]


def _drawn(study: Study, look: Look, options: Options) -> Chart:
    run, others = selected_run(study.matrix, options) or typical_run(study.matrix, study.fit), others_of(options)
    compared = [each.compared((run,)).runs[0] for each in (study, *map(study.beside, others))]
    if all(each.unstable for each in compared):
        raise unstable_on(run)
    names = titles_of((study.fit, *others), compared) if others else ("model",)
    stable = {name: each for name, each in zip(names, compared, strict=True) if not each.unstable}
    if others:
        told = [f"{words.describe(run)}: {len(names)} models"]
    else:
        told = [words.verdict(study.fit), f"{words.describe(run)}: {words.left(compared[0])}"]
    headline = words.headline(study.matrix.actuator, "residual over frequency")
    return residual_spectrum(stable, study.floors.by_run[run.id], told, headline, look)


RESIDUAL_SPECTRUM = Drawing("residual-spectrum", "Residual over frequency", Study, _drawn, (RUN, OTHER), share=0.79)
