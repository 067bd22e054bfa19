"""The file of passes, passes.toml: written, and read with its values checked."""

import hashlib
from collections.abc import Iterator
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from uplift.colorimetry import observer
from uplift.common.arrays import StrPath
from uplift.common.errors import OptionError, PassesError
from uplift.common.files import write_text
from uplift.extras.files.spec import SpecModel, problem, read_toml
from uplift.extras.files.toml import (
    matrix_value,
    number_value,
    row_value,
    text_value,
)
from uplift.extras.scene.passes.bands import CHANNELS, MAX_PASSES, MAX_WIDTH, Bands
from uplift.extras.scene.passes.light_paths import MAX_BOUNCES
from uplift.extras.scene.passes.passes import Passes, PassesCamera, PassesLight

FORMAT: Literal["uplift passes 1"] = "uplift passes 1"
HINT = "choose the passes again"
MAX_BANDS = CHANNELS * MAX_PASSES
MAX_LIGHTS = 100
SAMPLES = len(observer.grid())
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
    return HEAD + "\n".join(_lines(passes)) + "\n"


def _lines(passes: Passes) -> Iterator[str]:
    yield f"format = {text_value(FORMAT)}"
    yield f"centres = {row_value(passes.bands.centres)}"
    yield f"width = {number_value(passes.bands.width)}"
    yield f"to-xyz = {matrix_value(passes.to_xyz)}"
    yield ""
    yield "[materials]"
    for key, value in passes.origin.items():
        yield f"{key} = {_value(value)}"
    for light in passes.lights:
        yield ""
        yield "[[lights]]"
        yield f"name = {text_value(light.name)}"
        yield f"digest = {text_value(light.digest)}"
        yield f"numbers = {row_value(light.numbers)}"
        yield f"to-xyz = {matrix_value(light.to_xyz)}"
        yield f"errors = {row_value(light.errors)}"
        yield f"own-errors = {row_value(light.own_errors)}"
    if passes.camera is not None:
        yield ""
        yield "[camera]"
        yield f"name = {text_value(passes.camera.name)}"
        yield f"matrix = {matrix_value(passes.camera.matrix)}"
        yield f"error = {number_value(passes.camera.error)}"
    yield ""
    yield "[other-lights]"
    yield f"wavelengths = {row_value(observer.grid()[[0, -1]])}"
    yield f"projection = {matrix_value(passes.light_projection)}"


def _value(value: object) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(text_value, value))}]"
    return str(value) if isinstance(value, int) else text_value(str(value))


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
    text = f"{row_value(passes.bands.centres)} {number_value(passes.bands.width)}"
    return hashlib.sha256(text.encode()).hexdigest()[:16]


_Number = Annotated[float, Field(allow_inf_nan=False, ge=-1e9, le=1e9)]
_Positive = Annotated[float, Field(allow_inf_nan=False, ge=0, le=1e9)]
_BandRow = Annotated[list[_Number], Field(min_length=CHANNELS, max_length=MAX_BANDS)]
_ToXyz = Annotated[list[_BandRow], Field(min_length=3, max_length=3)]
_Errors = Annotated[
    list[_Positive], Field(min_length=MAX_BOUNCES, max_length=MAX_BOUNCES)
]
_PowerRow = Annotated[list[_Number], Field(min_length=SAMPLES, max_length=SAMPLES)]


class _LightTable(SpecModel):
    name: Annotated[str, Field(min_length=1, max_length=200)]
    digest: str
    numbers: Annotated[
        list[_Positive], Field(min_length=CHANNELS, max_length=MAX_BANDS)
    ]
    to_xyz: _ToXyz
    errors: _Errors
    own_errors: _Errors

    def light(self) -> PassesLight:
        """Return the light."""
        return PassesLight(
            name=self.name,
            digest=self.digest,
            numbers=np.array(self.numbers),
            to_xyz=np.array(self.to_xyz),
            errors=np.array(self.errors),
            own_errors=np.array(self.own_errors),
        )


class _OtherLights(SpecModel):
    wavelengths: Annotated[list[_Number], Field(min_length=2, max_length=2)]
    projection: Annotated[
        list[_PowerRow], Field(min_length=CHANNELS, max_length=MAX_BANDS)
    ]


class _CameraTable(SpecModel):
    name: Annotated[str, Field(min_length=1, max_length=200)]
    matrix: _ToXyz
    error: _Positive

    def camera(self) -> PassesCamera:
        """Return the camera."""
        return PassesCamera(self.name, np.array(self.matrix), self.error)


class _Materials(SpecModel, extra="allow"):
    source: Literal["library", "scene"]
    names: list[str]
    cube: str = ""


class _PassesTable(SpecModel):
    format: Literal["uplift passes 1"]
    centres: Annotated[list[_Number], Field(min_length=CHANNELS, max_length=MAX_BANDS)]
    width: Annotated[float, Field(allow_inf_nan=False, ge=0, le=MAX_WIDTH)]
    to_xyz: _ToXyz
    materials: _Materials
    lights: Annotated[list[_LightTable], Field(min_length=1, max_length=MAX_LIGHTS)]
    other_lights: _OtherLights
    camera: _CameraTable | None = None

    @model_validator(mode="after")
    def _sizes_agree(self) -> Self:
        bands = len(self.centres)
        if bands % CHANNELS:
            raise problem(f"centres must be 3, 6, 9 or 12, got {bands}")
        rows = [("to-xyz", row) for row in self.to_xyz]
        if self.camera is not None:
            rows += [("matrix of the camera", row) for row in self.camera.matrix]
        for light in self.lights:
            rows.append((f"numbers of the light '{light.name}'", light.numbers))
            for row in light.to_xyz:
                rows.append((f"to-xyz of the light '{light.name}'", row))
        for name, values in rows:
            if len(values) != bands:
                raise problem(
                    f"{name} must have {bands} columns, one per centre, got "
                    f"{len(values)}"
                )
        count = len(self.other_lights.projection)
        if count != bands:
            raise problem(
                f"other-lights.projection must have as many rows as there are centres, "
                f"{bands}, got {count}"
            )
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
    file = read_toml(path, PassesError)
    table = file.validate(_PassesTable, hint=HINT)
    try:
        bands = Bands(tuple(table.centres), table.width)
    except OptionError as error:
        file.fail((), error.problem, hint=HINT)
    first, last = table.other_lights.wavelengths
    if (first, last) != (observer.START, observer.END):
        known = f"[{observer.START:g}, {observer.END:g}]"
        file.fail(("other-lights", "wavelengths"), f"must be {known}", hint=HINT)
    names = [light.name for light in table.lights]
    if len(set(names)) < len(names):
        file.fail(("lights",), "must have different names", hint=HINT)
    materials = table.materials.model_dump(by_alias=True)
    origin = {key: value for key, value in materials.items() if value != ""}
    return Passes(
        bands,
        np.array(table.to_xyz),
        tuple(light.light() for light in table.lights),
        np.array(table.other_lights.projection),
        origin,
        None if table.camera is None else table.camera.camera(),
    )
