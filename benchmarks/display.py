"""The picture of gamut mapping of docs/guides/acescg.md."""

import numpy as np

from benchmarks import DOCS
from uplift.colorimetry.gamut import METHODS, SRGB, Primaries, conversion, map_to_gamut
from uplift.extras.colour.srgb import encode
from uplift.extras.pages.figure import write_figure
from uplift.extras.pages.marks import picture
from uplift.extras.pages.panels import Panel, draw

REC_2020 = Primaries((0.708, 0.292), (0.170, 0.797), (0.131, 0.046), (0.3127, 0.3290))
MAPPINGS = tuple(method for method in METHODS if method != "error")


def draw_hues() -> None:
    """Draw the hues of Rec. 2020 as each method maps them, from dark to three times
    white.
    """
    hue = np.linspace(0, 6, 360)
    pure = np.clip(np.abs((hue[:, None] + [3, 1, 5]) % 6 - 3) - 1, 0, 1)
    brightness = np.geomspace(3, 0.02, 180)[:, None, None]
    image = (brightness * pure) @ conversion(REC_2020, SRGB).T
    panels = []
    for method in MAPPINGS:
        mapped = encode(map_to_gamut(image, SRGB, method).rgb)
        panels.append(Panel([picture(mapped, interpolation="antialiased")], method))
    figure = draw(panels, len(panels), 2.4)
    write_figure(figure, DOCS / "display" / "ways.png", force=True)


QUESTIONS = {"picture": draw_hues}
