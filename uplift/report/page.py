"""A report as one HTML page that needs nothing else: no network, no other file, no script to be read."""

from __future__ import annotations

from importlib.resources import files

from uplift.report.assessment import Assessment
from uplift.report.page_crowding import crowding_section, crowding_told
from uplift.report.page_entries import entries_section
from uplift.report.page_lattice import distributions_section, failures_section
from uplift.report.page_standard_error import mean_told, standard_error_section, standard_error_told
from uplift.viz.format import format_scientific, pluralise
from uplift.viz.markup import Markup, element, joined


def page(found: Assessment, worst: int) -> str:
    """The whole HTML text; the spectra of the ``worst`` entries are drawn. The same cube gives the same text."""
    head = element(
        "head",
        element("meta", charset="utf-8"),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("title", f"{found.name} – uplift report"),
        element("style", _resource("page.css")),
    )
    body = element(
        "body",
        element(
            "header", element("h1", found.name), element("p", _lead(found), class_="lead"), _verdicts(found)
        ),
        _build(found),
        failures_section(found),
        distributions_section(found),
        standard_error_section(found),
        crowding_section(found),
        entries_section(found, worst),
        _footer(found),
        element("script", _resource("page.js")),
    )
    return f"<!DOCTYPE html>\n{element('html', head, body, lang='en')}\n"


def _resource(name: str) -> Markup:
    return Markup(files("uplift.viz").joinpath(name).read_text(encoding="utf-8"))


def _lead(found: Assessment) -> str:
    facts = found.facts
    names = [str(source["name"]) for source in found.data.provenance.get("atlases", ())]
    origin = f"built from {', '.join(names)}" if names else "built without an atlas"
    return (
        f"Spectral uplifting cube: {facts['model']['name']} with {facts['coefficients']} coefficients on "
        f"{facts['dim']}³ points, {facts['space']} under {facts['illuminant']}, {origin}."
    )


def _verdicts(found: Assessment) -> Markup:
    """What somebody in a hurry wants to know."""
    missed, exact = found.failures.missed, found.round_trips["spectra"]
    cards = [
        _verdict(
            f"{missed:,} over the threshold" if missed else "Every point fitted",
            f"{pluralise(found.facts['points'], 'lattice point')}, "
            f"worst distance {format_scientific(found.distance.largest)}",
            bad=missed > 0,
        ),
        _verdict(
            f"ΔE00 ≤ {format_scientific(exact.largest)}",
            "between a colour asked and the colour that comes back, in mode spectra",
            bad=exact.largest > 1,
        ),
    ]
    if found.entries is not None:
        errors = found.entries
        light = found.lights[int(errors.delta_e[0].argmax())].illuminant
        cards.append(
            _verdict(
                f"Worst ΔE00 {errors.worst[0]:.2f}",
                f"{errors.names[0]} under {light}; mean {errors.delta_e.mean():.2f} over "
                f"{pluralise(len(errors.names), 'entry', 'entries')} and {pluralise(len(found.lights), 'light')}",
            )
        )
    if found.crowding is not None:
        cards.append(_verdict(*crowding_told(found, found.crowding), bad=bool(found.crowding.lost)))
    if found.standard_error is not None:
        cards.append(_verdict(*standard_error_told(found, found.standard_error)))
    return element("div", *cards, class_="verdicts")


def _verdict(title: str, text: str, *, bad: bool = False) -> Markup:
    return element("div", element("b", title), element("span", text), class_="bad" if bad else None)


def _build(found: Assessment) -> Markup:
    facts, data = found.facts, found.data
    options = data.provenance.get("options", {})
    nodes = data.lattice.nodes
    shown: list[tuple[str, str | Markup]] = [
        ("model", ", ".join(f"{_value(value)}" for value in _flat(facts["model"]))),
        ("coefficients", f"{facts['coefficients']} a point"),
        (
            "lattice",
            f"{facts['points']:,} points {'=' if data.complete_cells is None else 'of'} {facts['dim']}³",
        ),
        ("axes", f"linear RGB {nodes[0]:g} to {nodes[-1]:g}, spaced {options.get('axis', 'as stored')}"),
        ("space", facts["space"]),
        ("illuminant", facts["illuminant"]),
        ("observer", facts["observer"]),
        ("wavelengths", f"{data.sensor.wavelengths[0]:g}–{data.sensor.wavelengths[-1]:g} nm"),
        ("threshold", f"{data.threshold:g}, max |linear RGB|"),
        ("entries", f"{len(data.atlas.names):,}"),
        ("standard error", mean_told(found)),
        ("file", f"{found.size / 1e6:.2f} MB, made by uplift {data.provenance.get('uplift', 'unknown')}"),
    ]
    wide = [(str(source["name"]), element("code", str(source["digest"]))) for source in _sources(found)]
    stated = ", ".join(f"{name} {_value(value)}" for name, value in options.items())
    items = [_fact(name, value) for name, value in shown]
    items += [_fact("options", stated, "wide"), *(_fact(name, value, "wide") for name, value in wide)]
    items.append(_fact("cube digest", element("code", str(facts["digest"])), "wide"))
    return element("section", element("h2", "Build"), element("dl", *items))


def _sources(found: Assessment) -> list[dict[str, object]]:
    return list(found.data.provenance.get("atlases", ()))


def _fact(name: str, value: str, class_: str | None = None) -> Markup:
    return element("div", element("dt", name), element("dd", value), class_=class_)


def _flat(model: dict[str, object]) -> list[object]:
    """The model's description without its braces."""
    return [
        part
        for name, value in model.items()
        for part in (
            _flat(value)
            if isinstance(value, dict)
            else [value if name == "name" else f"{name} {_value(value)}"]
        )
    ]


def _value(value: object) -> str:
    if isinstance(value, list | tuple):
        return " ".join(map(_value, value))
    return f"{value:g}" if isinstance(value, float) else str(value)


def _footer(found: Assessment) -> Markup:
    return element(
        "footer",
        joined(
            [
                element(
                    "p",
                    "ΔE00 is CIEDE2000 between reflectances seen by the cube's observer under a light, against that "
                    "light's white. Swatches show the XYZ under the light, taken to the white of the screen by "
                    "Bradford adaptation and encoded as sRGB; what the screen cannot show is clipped. rms is over "
                    "the cube's wavelengths, in units of reflectance. The cube was asked in mode spectra; the page "
                    "holds no hour and no place, so the same cube gives the same page.",
                )
            ]
        ),
    )
