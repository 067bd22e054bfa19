"""Figures: colours and style in one place, empty figures and axes, PNG, SVG and PDF
output.
"""

import hashlib
import io
import os
import re
from collections.abc import Sequence
from contextlib import AbstractContextManager
from typing import Any

import numpy as np
from markupsafe import Markup, escape
from numpy.typing import NDArray

from uplift.common.arrays import Array, StrPath
from uplift.common.errors import OutputError, needs_package
from uplift.common.files import atomic_write
from uplift.common.text import printable

INK = "#262626"
GREY = "#6e6e6e"
PALE = "#d6d6d6"
ACCENT = "#20509a"
# A broad line below others.
BAND = "#c2c2c2"
# A group that has no colour.
OTHER = "#444444"
HIGHLIGHT = "#ff5a00"
# For `matplotlib.rc_context`.
STYLE: dict[str, Any] = {
    "svg.fonttype": "none",
    "svg.hashsalt": "uplift",
    "font.size": 8,
    "axes.linewidth": 0.6,
    "axes.edgecolor": GREY,
    "axes.labelcolor": GREY,
    "xtick.color": GREY,
    "ytick.color": GREY,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.minor.width": 0.4,
}

# Formats of figures, and entries with which equal figures give equal files: without
# them matplotlib writes its name and version, and the time.
METADATA: dict[str, dict[str, str | None]] = {
    ".png": {"Software": "uplift"},
    ".svg": dict.fromkeys(("Creator", "Date", "Format", "Type")),
    ".pdf": dict.fromkeys(("CreationDate", "Producer")),
}
SUFFIXES = tuple(METADATA)
HAIR_SPACE = "\u200a"
# Properties of the style sheet of pages in place of colours; it lightens all other
# colours in the dark scheme.
PAGE_COLOURS = {
    INK: "var(--ink)",
    GREY: "var(--grey)",
    PALE: "var(--line)",
    BAND: "var(--band)",
    ACCENT: "var(--accent)",
    "#000000": "var(--ink)",
    "#ffffff": "var(--card)",
}
_COLOUR = re.compile(r"(?<=: )#[0-9a-f]{6}\b")
# Names of groups, comments, and a style sheet that would apply to the whole page.
_UNUSED = re.compile(
    r' id="[\w.]+_\d+"|<!--.*?-->|<defs>\s*<style.*?</style>\s*</defs>', re.DOTALL
)
_IDENTIFIER = re.compile(r'(id="|#)([mp][0-9a-f]{10})(?=["\)])')


def matplotlib() -> Any:
    """Import matplotlib. Raises `OutputError` if it, or what places labels, is not
    installed.
    """
    with needs_package("figures", OutputError):
        import matplotlib.figure
        import textalloc  # noqa: F401
    return matplotlib


def styled() -> AbstractContextManager[None]:
    """Draw in `STYLE` in the block."""
    style: AbstractContextManager[None] = matplotlib().rc_context(STYLE)
    return style


def figure_text(text: str) -> str:
    """Prepare text that comes from a file for a figure, which shows it as it is.

    matplotlib reads text between dollar signs as mathematics, and leaves labels that
    begin with an underscore out of legends.
    """
    shown = "\n".join(map(printable, text.split("\n"))).replace("$", r"\$")
    return f"{HAIR_SPACE}{shown}" if shown.startswith("_") else shown


def style_axes(axes: Any) -> None:
    """Remove the frame above and on the right, and draw a grid behind the data."""
    axes.grid(color=PALE, linewidth=0.5)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def check_suffix(path: StrPath, suffixes: Sequence[str] = SUFFIXES) -> str:
    """Return the format of a figure's file, by its suffix. Raises `OutputError`, also
    without matplotlib.
    """
    suffix = os.path.splitext(path)[1].lower()
    if suffix not in suffixes:
        problem = (
            f"the suffix of a plot must be one of {', '.join(suffixes)}, got '{suffix}'"
        )
        hint = f"name the file accordingly, such as plot{suffixes[0]}"
        raise OutputError(problem, path=path, hint=hint)
    matplotlib()
    return suffix


def write_figure(figure: Any, path: StrPath, *, force: bool = False) -> None:
    """Write a figure as PNG, SVG or PDF, by the suffix of its file. Equal figures give
    equal files.
    """
    content = render(figure, check_suffix(path))
    # matplotlib itself would fail in other ways on a full disk.
    with atomic_write(path, force=force) as temporary:
        temporary.write_bytes(content)


def render(figure: Any, suffix: str) -> bytes:
    """Return the file of a figure in the format of a suffix."""
    content = io.BytesIO()
    with styled():
        options = {"metadata": METADATA[suffix], "dpi": figure.dpi}
        figure.savefig(content, format=suffix[1:], **options)
    return content.getvalue()


def to_svg(figure: Any, label: str = "") -> Markup:
    """Render a figure as an ``svg`` element for a page that sets its size."""
    text = render(figure, ".svg").decode()
    text = text[text.index("<svg") :].replace("xlink:href", "href")
    text = _UNUSED.sub("", text)
    suffix = hashlib.sha256(text.encode()).hexdigest()[:8]
    text = _IDENTIFIER.sub(rf"\1\2-{suffix}", text)
    head, body = text.split(">", 1)
    head = re.sub(r' (?:width|height|version|xmlns:xlink)="[^"]*"', "", head)
    body = re.sub(r">\s+<", "><", body).strip()
    role = f' role="img" aria-label="{escape(printable(label))}"' if label else ""
    return Markup(f"{head}{role}>{body}")


def to_page_svg(figure: Any, label: str = "") -> Markup:
    """Render a figure without background as an ``svg`` element.

    Its colours follow the light or dark scheme of ``extras/pages/page.css``.
    """
    for background in (figure.patch, *(axes.patch for axes in figure.axes)):
        background.set_visible(False)
    return Markup(
        _COLOUR.sub(lambda found: _page_colour(found[0]), to_svg(figure, label))
    )


def _page_colour(colour: str) -> str:
    return PAGE_COLOURS.get(colour) or f"color-mix(in oklab, {colour}, var(--lift))"


RAMP = ("#eef5f8", "#a9cfe3", "#5a9fcb", "#20609a", "#0b1d51")


def colour_map() -> Any:
    """Return the ramp as a colour map of matplotlib."""
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list("ramp", RAMP)


def ramp_codes(values: Array | Sequence[float]) -> NDArray[np.uint8]:
    """Return 8-bit sRGB codes (..., 3) of values (...) in [0, 1]."""
    anchors = np.array([list(bytes.fromhex(code[1:])) for code in RAMP], dtype=float)
    positions = np.linspace(0, 1, len(RAMP))
    channels = [np.interp(values, positions, column) for column in anchors.T]
    return np.rint(np.stack(channels, axis=-1)).astype(np.uint8)
