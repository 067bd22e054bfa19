"""The part of a report's page that draws spectra: small multiples of the worst entries."""

from __future__ import annotations

from uplift.report.assessment import Assessment
from uplift.report.charts import spectra_chart
from uplift.report.fidelity import EntryErrors
from uplift.report.page_parts import Swatches, severity, swatch
from uplift.viz.figure import ACCENT, BAND, INK
from uplift.viz.format import format_rgb
from uplift.viz.markup import Markup, element, joined


def small_multiples(found: Assessment, entries: EntryErrors, shown: Swatches, worst: int) -> Markup:
    """The first ``worst`` entries, each under every light and as spectra."""
    figures = (_figure(found, entries, row, shown) for row in range(min(worst, len(entries.names))))
    return joined([_key(entries), element("div", *figures, class_="grid")])


def _figure(found: Assessment, entries: EntryErrors, row: int, shown: Swatches) -> Markup:
    lattice = None if entries.lattice is None else entries.lattice[row]
    strips = [
        element(
            "span",
            swatch(*shown[column][row][:2]),
            element("span", seen.illuminant),
            element("b", f"{value:.2f}", class_=severity(value) or "plain"),
        )
        for column, (seen, value) in enumerate(zip(found.lights, entries.delta_e[row].tolist(), strict=True))
    ]
    name = element("b", entries.names[row], title=format_rgb(entries.rgb[row]))
    return element(
        "figure",
        element("figcaption", name, element("small", f"rms {entries.rms[row]:.4f}")),
        element("div", *strips, class_="strip"),
        spectra_chart(found.data.sensor.wavelengths, entries.wanted[row], entries.answered[row], lattice),
    )


def _key(entries: EntryErrors) -> Markup:
    lines: list[tuple[str, str, float, str | None]] = [
        ("measured", BAND, 5, None),
        ("answered", ACCENT, 1.8, None),
    ]
    if entries.lattice is not None:
        lines.append(("lattice by itself", INK, 1.8, "2 2.6"))
    parts = [
        element(
            "span",
            element(
                "svg",
                element(
                    "path",
                    d="M0 4H34",
                    stroke=colour,
                    stroke_width=str(width),
                    stroke_dasharray=dash,
                    fill="none",
                ),
                viewBox="0 0 34 8",
            ),
            name,
            class_="key",
        )
        for name, colour, width, dash in lines
    ]
    end = "Reflectance over wavelength in nm; below each light, ΔE00. Swatches: measured on the left, answered right."
    return element("p", *parts, element("br"), end, class_="note")
