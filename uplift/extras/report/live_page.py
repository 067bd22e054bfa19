"""Live page: one HTML file with a cube, the exported GLSL program and a few lights."""

import base64
from pathlib import Path

import numpy as np

from uplift.colorimetry.observer import light
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.common.files import write_text
from uplift.common.text import pluralise
from uplift.cube.data import CubeData
from uplift.extras.colour.srgb import hex_codes
from uplift.extras.export.program import cube_program
from uplift.extras.export.program_table import COLUMNS, check_complete, make_table
from uplift.extras.pages.html import Markup, render, resource
from uplift.lookup.cube import Cube

# illuminants to choose from
LIGHTS = ("D65", "A", "D50", "FL2", "FL11", "HP1", "LED-B3")
GROUP = 4  # wavelengths of one call of the program
SPACE = "sRGB"


def export(cube: Cube, path: Path, style: str, *, force: bool) -> str:
    """Write the live page of a cube."""
    write_text(page(cube.data), path, force=force)
    return f"page, {path.stat().st_size / 1e6:.1f} MB"


def page(data: CubeData) -> str:
    """Render the live page of a cube: it relights images by spectra, next to a product
    of RGB.
    """
    check_complete(data, "a page")
    if data.sensor.space != SPACE:
        problem = f"a page shows images in sRGB, got a cube of {data.sensor.space}"
        raise OptionError(problem, hint="build the cube without another RGB space")
    table = make_table(data, "spectra")
    program = cube_program(data, table, "glsl", "spectra", "cube", "file")
    image = table.image()
    at, weights = _weights(data)
    names = list(weights)
    numbers = {
        "columns": COLUMNS,
        "rows": len(image),
        "points": data.lattice.size + len(data.atlas.names),
        "wavelengths": at.tolist(),
        "lights": {name: np.round(weights[name], 9).tolist() for name in names},
        "entries": hex_codes(data.atlas.rgb),
    }
    return render(
        "extras/report/templates/live_page.html.j2",
        title="Your images under other lights",
        lead=f"Spectra of a cube of {data.lattice.dim}³ nodes and "
        f"{pluralise(len(data.atlas.names), 'atlas entry')}, "
        f"evaluated in the browser for every pixel. Drop an image on the page.",
        lights=names,
        second=next(name for name in ("A", "FL11") if name != names[0]),
        numbers=numbers,
        kernel=Markup(program.replace("</", "< /")),
        table=base64.b64encode(image.astype("<f4").tobytes()).decode(),
        script=resource(
            "extras/pages/draw.js",
            "extras/pages/webgl.js",
            "extras/report/live_page.js",
        ),
    )


def _weights(data: CubeData) -> tuple[Array, dict[str, Array]]:
    """Return wavelengths (N,) and, for each light, the weights (3, N) from reflectance
    to linear sRGB.
    """
    sensor = data.sensor
    at = data.sensor.wavelengths
    missing = -len(at) % GROUP
    return np.pad(at, (0, missing), mode="edge"), {
        name: np.pad(
            sensor.xyz_to_rgb @ light(name, sensor.observer, *sensor.range).xyz,
            ((0, 0), (0, missing)),
        )
        for name in dict.fromkeys((sensor.illuminant, *LIGHTS))
    }
