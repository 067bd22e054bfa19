"""The file of passes, passes.toml: written, and read with its values checked."""

import hashlib
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from uplift.colorimetry import observer
from uplift.common.arrays import StrPath
from uplift.common.errors import OptionError, PassesError
from uplift.common.files import write_text
from uplift.extras.files.spec import (
    Matrix,
    Number,
    Row,
    SpecModel,
    check_shape,
    problem,
    read_spec,
)
from uplift.extras.files.toml import toml_text, toml_value
from uplift.extras.scene.passes.bands import Bands
from uplift.extras.scene.passes.light_paths import MAX_BOUNCES
from uplift.extras.scene.passes.passes import Passes, PassesCamera, PassesLight

FORMAT: Literal["uplift passes 1"] = "uplift passes 1"
HINT = "choose the passes again"
HEAD = """# Bands of wavelengths for an RGB renderer, by uplift passes choose.
# Pass p renders the bands 3p + 1, 3p + 2 and 3p + 3 as red, green and blue.
"""


def to_toml(passes: Passes) -> str:
    """Write passes as the text of a TOML file.

    Parameters
    ----------
    passes : Passes
        The passes.

    Returns
    -------
    str
        The text; `read_passes` reads it.
    """
    ends = [observer.START, observer.END]
    tables = {
        "format": FORMAT,
        "centres": np.array(passes.bands.centres, dtype=float),
        "width": float(passes.bands.width),
        "to_xyz": passes.to_xyz,
        "materials": passes.origin,
        "lights": list(map(vars, passes.lights)),
        "camera": None if passes.camera is None else vars(passes.camera),
        "other_lights": {"wavelengths": ends, "projection": passes.light_projection},
    }
    return f"{HEAD}{toml_text(tables)}\n"


def write_passes(passes: Passes, path: StrPath, *, force: bool = False) -> None:
    """Write passes to a TOML file, atomically.

    Parameters
    ----------
    passes : Passes
        The passes.
    path : path-like
        File to write.
    force : bool
        Whether to replace an existing file.

    Raises
    ------
    OutputError
        The file cannot be written, or exists and ``force`` is off.
    """
    write_text(to_toml(passes), path, force=force)


def passes_digest(passes: Passes) -> str:
    """Compute the digest of the bands, which images of these passes carry.

    Parameters
    ----------
    passes : Passes
        The passes.

    Returns
    -------
    str
        First 16 hexadecimal digits of the SHA-256 of centres and width.
    """
    centres = toml_value(np.array(passes.bands.centres, dtype=float))
    text = f"{centres} {toml_value(float(passes.bands.width))}"
    return hashlib.sha256(text.encode()).hexdigest()[:16]


class _Materials(SpecModel, extra="allow"):
    source: Literal["library", "scene"]
    names: list[str]


class _OtherLights(SpecModel):
    wavelengths: Row
    projection: Matrix


class _PassesFile(SpecModel):
    format: Literal["uplift passes 1"]
    centres: Row
    width: Number
    to_xyz: Matrix
    materials: _Materials
    lights: Annotated[tuple[PassesLight, ...], Field(min_length=1)]
    other_lights: _OtherLights
    camera: PassesCamera | None = None

    def bands(self) -> Bands:
        """Return the bands. Raises `OptionError`."""
        return Bands(tuple(self.centres.tolist()), self.width)

    @model_validator(mode="after")
    def _check(self) -> Self:
        try:
            count = len(self.bands())
        except OptionError as error:
            raise problem(error.problem) from error
        matrix = (3, count)
        check_shape(self.to_xyz, matrix, "to-xyz")
        for row, light in enumerate(self.lights):
            check_shape(light.numbers, (count,), "lights", row, "numbers")
            check_shape(light.to_xyz, matrix, "lights", row, "to-xyz")
            check_shape(light.errors, (MAX_BOUNCES,), "lights", row, "errors")
            check_shape(light.own_errors, (MAX_BOUNCES,), "lights", row, "own-errors")
        if self.camera is not None:
            check_shape(self.camera.matrix, matrix, "camera", "matrix")
        powers = (count, len(observer.grid()))
        check_shape(self.other_lights.projection, powers, "other-lights", "projection")
        known = [observer.START, observer.END]
        if self.other_lights.wavelengths.tolist() != known:
            raise problem(f"must be {known}", at=("other-lights", "wavelengths"))
        if len({light.name for light in self.lights}) < len(self.lights):
            raise problem("must have different names", at=("lights",))
        return self


def read_passes(path: StrPath) -> Passes:
    """Read a file of passes.

    Parameters
    ----------
    path : path-like
        A TOML file that `write_passes` wrote.

    Returns
    -------
    Passes

    Raises
    ------
    PassesError
        The file cannot be read or a value does not fit; the error names the key.
    """
    file = read_spec(path, _PassesFile, PassesError, hint=HINT)
    return Passes(
        file.bands(),
        file.to_xyz,
        file.lights,
        file.other_lights.projection,
        file.materials.model_dump(),
        file.camera,
    )
