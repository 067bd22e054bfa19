"""The chart as a figure for readers in a hurry, and as a page of panels with tooltips.

Of the cubes of this package a panel of the page shows those that no other cube of the
same kind and mode beats.
"""

from dataclasses import replace

from uplift.common.arrays import StrPath
from uplift.extras.colour.light_sets import CHART_LIGHTS
from uplift.extras.pages.figure import ACCENT, GREY, OTHER, write_figure
from uplift.extras.pages.format import (
    format_build_time,
    format_error,
    format_size,
    format_time,
)
from uplift.extras.pages.html import Tooltip, render
from uplift.extras.pages.marks import shade, threshold
from uplift.extras.pages.panels import Axis, Dot, Panel, draw, page_svg
from uplift.extras.pages.pareto import family_colours, front_panel
from uplift.lab.chart.results import (
    SUMMARY,
    Chart,
    Criterion,
    MethodResult,
    State,
    criteria,
    reference_batch,
)

COLOURS = {
    "uplift, moments with atlas": "#0b3c8c",
    "uplift, moments": "#4f9be8",
    "uplift, sigmoid with atlas": "#0a6b60",
    "uplift, sigmoid": "#3dbfa9",
    "uplift, C export": "#b8860b",
    "Burns 2019": "#5b7083",
    "Jakob 2019": "#d1495b",
    "Local-linear regression": "#a86f9c",
    "Mallett 2019": "#8e44ad",
    "Mean of metamers": "#c49a6c",
    "Meng 2015": "#8c5a2b",
    "Mitsuba 3": "#f08c2e",
    "Otsu 2018": "#d63fa0",
    "Smits 1999": "#7a9a1d",
}
"""Colours of families; those of other versions are dark grey."""
MODES = {"spectra": "o", "moments": "^", "refined": "s", "nearest": "D", "bulk": "P"}
"""Markers of cubes of this package, by mode of lookup; other methods are stars."""
OURS = "uplift"
NAMES = {
    "smits1999-float32": "Smits 1999",
    "mallett2019-float32": "Mallett & Yuksel 2019",
    "mitsuba3-llvm": "Mitsuba 3, compiled",
    "jakob2019-table64": "Jakob & Hanika's table",
    "otsu2018": "Otsu 2018",
    "meng2015": "Meng 2015",
    "c-moments9-32-spectra": OURS,
}
"""Methods of the figure and their names in it; a chart without these shows all of its
methods.
"""
ATLAS = "c-moments9-32-atlas-spectra"
"""Cube of the figure whose error is that of the materials of its atlas."""
ERRORS = {
    "round_trip": "round trip, 1 nm",
    "coarse_round_trip": "round trip, 5 nm",
    **{light: light for light in CHART_LIGHTS},
    "rms": "rms",
    "own_lights": "own, mean",
}
"""Columns of the table: headings by names of errors."""


def drawn_results(criterion: Criterion, chart: Chart) -> list[MethodResult]:
    """Cubes of this package that none of the same kind and mode beats, then all other
    methods, above them.
    """
    kinds: dict[tuple[str, ...], list[MethodResult]] = {}
    for result in chart.measured:
        kind = (result.family, result.mode) if result.build else (result.method,)
        kinds.setdefault(kind, []).append(result)
    drawn: list[MethodResult] = []
    for results in kinds.values():
        drawn += criterion.front(results)
    return sorted(drawn, key=lambda result: not result.build)


def criterion_panel(criterion: Criterion, chart: Chart, number: int) -> Panel:
    """Return the panel of a criterion, whose markers have the keys NUMBER-ROW."""
    named: list[Dot] = []
    unnamed: list[Dot] = []
    drawn = drawn_results(criterion, chart)
    for result, point in criterion.points(drawn).items():
        dot = Dot(
            *point,
            result.label,
            COLOURS.get(result.family, OTHER),
            MODES.get(result.mode, "*"),
            hollow=result.numbers[f"ns_{criterion.batch}_colours"] < criterion.batch,
            key=f"{number}-{chart.results.index(result)}",
        )
        is_variant = result.build or result.method.endswith("-float32")
        (unnamed if is_variant else named).append(dot)
    cost = Axis(criterion.axis, log=True, text=format_time)
    return front_panel(criterion.title, cost, named, unnamed)


def write_picture(chart: Chart, path: StrPath, *, force: bool = False) -> None:
    """Write the mean error of unseen materials over the time per RGB as PNG: every
    method has its name, this package the only colour. Raises `OutputError`.
    """
    _, unseen, *_, own = criteria(reference_batch(chart.batches))
    named = [result for result in chart.measured if result.method in NAMES]
    dots = []
    for result, point in unseen.points(named or chart.measured).items():
        dots.append(_dot(point, NAMES.get(result.method, result.title)))
    smallest = sorted(dots, key=lambda dot: dot.y)[:2]
    ranks = [f"{dot.text} in {format_time(dot.x)}" for dot in smallest]
    title = "Smallest errors on unseen materials\n" + ";  ".join(ranks)
    with_atlas = [result for result in chart.measured if result.method == ATLAS]
    for point in own.points(with_atlas).values():
        dot = _dot(point, OURS, " with the atlas, its own materials")
        dots.append(replace(dot, hollow=True))
    panel = Panel(
        [shade(0, 1), threshold(1, "just visible: 1")],
        title,
        Axis(f"{unseen.axis}, {unseen.colours}", log=True, text=format_time),
        Axis(f"mean {unseen.unit} of unseen materials", limits=(-0.05, None)),
        dots,
    )
    write_figure(draw([panel], size=(5.6, 3.4), dpi=200), path, force=force)


def _dot(point: tuple[float, float], name: str, of: str = "") -> Dot:
    colour = ACCENT if name == OURS else GREY
    text = f"{name}{of}, {point[1]:.2f}"
    return Dot(*point, text, colour, bold=name == OURS)


def render_chart(chart: Chart) -> str:
    """Render the page of a chart."""
    compared: list[Criterion] = []
    for batch in chart.batches:
        compared += criteria(batch)
    pictures = []
    for number, criterion in enumerate(compared):
        panel = criterion_panel(criterion, chart, number)
        pictures.append((criterion, page_svg(panel)))
    return render(
        "lab/chart/templates/page.html.j2",
        chart=chart,
        pictures=pictures,
        families=family_colours((result.family for result in chart.measured), COLOURS),
        tooltips=[_tooltip(chart, result) for result in chart.results],
        chosen=reference_batch(chart.batches),
        errors=ERRORS,
    )


def _tooltip(chart: Chart, result: MethodResult) -> Tooltip:
    numbers = result.numbers
    lines = []
    if result.state == State.MEASURED:
        for size in chart.batches:
            if (name := f"ns_{size}") in numbers:
                time = format_time(numbers[name])
                lines.append((f"{size:,} per call", f"{time} each"))
        lines += [
            ("set-up", format_build_time(numbers["setup_s"])),
            ("memory", format_size(numbers["bytes"])),
            ("errors", "mean / 99 % / largest"),
        ]
        for error, name in ERRORS.items():
            values = (numbers[f"{error}_{kind}"] for kind in SUMMARY)
            lines.append((name, " / ".join(map(format_error, values))))
        lines += [
            ("", text) for text in (result.build, result.call, result.note) if text
        ]
    return {"title": result.title, "family": result.family, "lines": lines}
