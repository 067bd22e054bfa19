"""The parts of a report's page that speak of failures and of distributions."""

from __future__ import annotations

from uplift.colorimetry.srgb import hex_codes
from uplift.report.assessment import Assessment
from uplift.report.page_parts import charts, figure, note, right, swatch, table
from uplift.viz.format import format_rgb, format_scientific, pluralise
from uplift.viz.markup import Markup, element, joined, number


def failures_section(found: Assessment) -> Markup:
    """Counts by status, the points over the threshold, the improvement steps, the entries that are missing."""
    failed, data = found.failures, found.data
    limit, points = f"{data.threshold:g}", found.facts["points"]
    if failed.missed:
        told = f"{pluralise(failed.missed, 'lattice point')} of {points:,} over the threshold of {limit}."
        first = element("p", told, class_="bad")
    else:
        first = element("p", f"Nothing failed: all {points:,} points evaluate to their RGB within {limit}.")
    status = table(
        ["status", right("points"), right("share")],
        [
            [label, number(f"{count:,}"), number(f"{count / data.lattice.size:.2%}")]
            for label, count in failed.counts.items()
        ],
    )
    columns = [
        element("div", element("h3", "Points by status"), status),
        _improvements(found),
        _missing(found),
    ]
    return element(
        "section",
        element("h2", "Failures"),
        first,
        _missed(found),
        element("div", *columns, class_="columns"),
    )


def _missed(found: Assessment) -> Markup | None:
    points, data = found.failures.points, found.data
    if not len(points):
        return None
    target = data.lattice.points[points]
    pairs = zip(
        hex_codes(target, data.sensor),
        hex_codes(data.points.rgb[points].astype(float), data.sensor),
        strict=True,
    )
    lines = [
        [
            swatch(*codes),
            format_rgb(target[row]),
            format_rgb(data.points.rgb[point]),
            number(format_scientific(float(data.points.distance[point]))),
        ]
        for row, (point, codes) in enumerate(zip(points, pairs, strict=True))
    ]
    title = f"The worst {len(points)}" if len(points) < found.failures.missed else "The points"
    return joined(
        [
            element("h3", title),
            table(["", "linear RGB of the point", "of its spectrum", right("distance")], lines),
        ]
    )


def _improvements(found: Assessment) -> Markup:
    steps = found.failures.improvements
    title = element("h3", "Improvement steps")
    if not steps:
        return element("div", title, element("p", "No step was needed: no point was over the threshold."))
    lines = [
        [str(step.get("step")), number(f"{step.get('tried', 0):,}"), number(f"{step.get('mended', 0):,}")]
        for step in steps
    ]
    return element("div", title, table(["step", right("tried"), right("mended")], lines))


def _missing(found: Assessment) -> Markup:
    failed = found.failures
    lists = [
        (failed.left_out, f"Left out, as {found.data.sensor.space} does not hold them: "),
        (failed.skipped, "Skipped, as the reader could not use them: "),
    ]
    told = [element("p", text, ", ".join(names), ".") for names, text in lists if names]
    return element("div", element("h3", "Entries not in the cube"), *(told or [element("p", "None.")]))


def distributions_section(found: Assessment) -> Markup:
    """Histograms: of the lattice, of colours that come back, of the entries under each light."""
    light, limit = found.data.sensor.illuminant, found.data.threshold
    lattice = [
        figure("Fitting distance of the lattice points", found.distance, "max |linear RGB|", limit=limit),
        figure("Smoothness: neighbouring points", found.smoothness, "rms difference of reflectance"),
        _aside(found),
    ]
    trips = [
        figure(f"Round trip in mode {mode}", part, f"ΔE00 under {light}")
        for mode, part in found.round_trips.items()
    ]
    count = found.round_trips["spectra"].counts.sum()
    told = f"{count:,} random linear RGB, {_whence(found)}: the colour asked against what comes back."
    parts = [element("h3", "Lattice"), charts(lattice)]
    parts += [element("h3", "Colours that come back"), note(told), charts(trips)]
    if found.delta_e:
        top = max(int(part.counts.max()) for part in found.delta_e.values())
        entries = [
            figure(f"Entries under {name}", part, "ΔE00", top=top) for name, part in found.delta_e.items()
        ]
        text = "Each entry asked at its own RGB: the answer against the measured spectrum, seen under each light."
        parts += [element("h3", "Entries"), note(text), charts(entries)]
    return element("section", element("h2", "Distributions"), *parts)


def _whence(found: Assessment) -> str:
    return (
        "the same for every cube" if found.data.complete_cells is None else "from the cells that the cube has"
    )


def _aside(found: Assessment) -> Markup:
    """What the charts of the lattice need to be read."""
    first, second = (format_rgb(rgb) for rgb in found.steepest)
    return element(
        "div",
        f"The dashed line is the threshold, {found.data.threshold:g}. Neighbours are points next to each other along "
        "an axis; between these two the spectrum changes most:",
        swatch(*hex_codes(found.steepest, found.data.sensor)),
        f"({first}) and ({second}).",
        class_="aside",
    )
