"""The part of a report's page that speaks of standard errors: what the cube states, and whether it holds."""

from __future__ import annotations

from uplift.report.assessment import Assessment
from uplift.report.calibration import Calibration
from uplift.report.page_parts import charts, figure, note
from uplift.viz.format import pluralise
from uplift.viz.histogram import Histogram
from uplift.viz.markup import Markup, element, joined

VERDICTS = {
    0: "Its standard errors hold.",
    1: "It is too sure of itself: these colours are unlike what its own atlas had it expect.",
    -1: "It is more careful than it need be.",
}


def standard_error_section(found: Assessment) -> Markup:
    """The distribution over the lattice, and how far it holds for entries that the cube has not seen."""
    title = element("h2", "Standard error")
    if found.standard_error is None:
        return element("section", title, element("p", _why_none(found)))
    light = found.data.error_illuminant
    about = (
        f"By how much an answer is expected to miss a measurement of the same colour: a root mean square, in ΔE00 "
        f"under {light}, that the cube has learnt by leaving out its own entries, one at a time. It is least at the "
        "entries, most far from them all."
    )
    part = figure("Standard error of the lattice points", found.standard_error, f"ΔE00 under {light}")
    if found.calibration is not None:
        beside = _calibration(found, found.calibration)
    else:
        told = "Whether that holds, only measurements can tell that the cube has not seen:"
        beside = element("p", told, element("code", f"uplift report {found.name} --atlas OTHER"))
    return element("section", title, note(about), charts([part, element("div", beside, class_="beside")]))


def _why_none(found: Assessment) -> str:
    if not found.data.atlas.names:
        why = "it was built without an atlas, so nothing tells how far measurements lie from its answers"
    else:
        count = pluralise(len(found.data.atlas.names), "entry", "entries")
        why = f"its {count} are too few to learn from how far measurements lie from its answers"
    return f"The cube states none: {why}."


def _calibration(found: Assessment, judged: Calibration) -> Markup:
    """Real errors against stated ones, in words."""
    light, count = found.data.error_illuminant, pluralise(judged.count, "entry", "entries")
    return joined(
        [
            element("h3", "Does it hold?"),
            element(
                "p",
                f"For the {count} of {', '.join(found.sources)} the cube expected to miss by ΔE00 ",
                element("b", f"{judged.stated:.2f}"),
                f" under {light}, and missed by ",
                element("b", f"{judged.real:.2f}"),
                f" (root mean squares). {VERDICTS[judged.verdict]}",
            ),
            element(
                "p",
                element("b", f"{judged.within_one:.0%}"),
                " of the entries lie within one standard error and ",
                element("b", f"{judged.within_two:.0%}"),
                " within two; about two in three and nineteen in twenty would, were all of them right. "
                "The table of entries has both, stated and real, for each.",
            ),
        ]
    )


def mean_told(found: Assessment) -> str:
    """The one figure, for the facts."""
    if found.standard_error is None:
        return "none"
    return f"mean {found.standard_error.mean:.2f}, ΔE00 under {found.data.error_illuminant}"


def standard_error_told(found: Assessment, part: Histogram) -> tuple[str, str]:
    """The same for those in a hurry: a title, and what it means."""
    light, judged = found.data.error_illuminant, found.calibration
    title = f"Standard error {part.mean:.2f}"
    if judged is None:
        return title, f"mean over the lattice points, ΔE00 under {light}"
    return (
        title,
        f"mean over the lattice points, ΔE00 under {light}; for these entries {judged.stated:.2f} stated, "
        f"{judged.real:.2f} real",
    )
