"""Pictures of spectra."""

from __future__ import annotations

import os
from collections.abc import Sequence

from uplift.files import replacing
from uplift.lookup import Answer, Cube

NAMED = 12
"""More lines than this are not named in a legend."""


def plot_answers(
    cube: Cube, answers: Sequence[Answer], path: str | os.PathLike[str], *, force: bool = False
) -> None:
    """Draw reflectances over wavelength, each in its own colour, as a PNG. Raises `OutputError`."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 4.0), layout="constrained")
    axes = figure.subplots()
    for answer in answers:
        codes = cube.encode(answer.rgb) / 255
        name = answer.entry or "#" + "".join(f"{round(255 * code):02x}" for code in codes)
        axes.plot(answer.wavelengths, answer.reflectance, color="0.25", linewidth=3.4, solid_capstyle="round")
        axes.plot(answer.wavelengths, answer.reflectance, color=tuple(codes), linewidth=2.4, label=name)
    axes.set(xlabel="wavelength / nm", ylabel="reflectance", ylim=(-0.02, 1.02))
    axes.margins(x=0.01)
    axes.grid(color="0.9")
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    if len(answers) <= NAMED:
        axes.legend(frameon=False)
    with replacing(path, force=force) as temporary:
        FigureCanvasAgg(figure).print_png(temporary, metadata={"Software": "uplift"})
