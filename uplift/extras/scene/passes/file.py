"""The file of passes, passes.toml: written, and read with its values checked."""

import hashlib
from collections.abc import Iterator, Sequence
from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field, model_validator

from uplift.colorimetry import observer
from uplift.common.arrays import StrPath
from uplift.common.errors import OptionError, PassesError
from uplift.common.files import write_text
from uplift.extras.files.spec import SpecModel, problem, read_toml
from uplift.extras.scene.passes.bands import CHANNELS, MAX_PASSES, MAX_WIDTH, Bands
from uplift.extras.scene.passes.light_paths import MAX_BOUNCES
from uplift.extras.scene.passes.passes import Passes, PassesCamera, PassesLight

FORMAT: Literal["uplift passes 1"] = "uplift passes 1"
HINT = "choose the passes again"
DIGITS = 9
"""Significant digits of numbers in the file."""
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
    yield f"format = {_text(FORMAT)}"
    yield f"centres = {_row(passes.bands.centres)}"
    yield f"width = {_number(passes.bands.width)}"
    yield f"to-xyz = {_matrix(passes.to_xyz)}"
    yield ""
    yield "[materials]"
    for key, value in passes.origin.items():
        yield f"{key} = {_value(value)}"
    for light in passes.lights:
        yield ""
        yield "[[lights]]"
        yield f"name = {_text(light.name)}"
        yield f"digest = {_text(light.digest)}"
        yield f"numbers = {_row(light.numbers)}"
        yield f"to-xyz = {_matrix(light.to_xyz)}"
        yield f"errors = {_row(light.errors)}"
        yield f"own-errors = {_row(light.own_errors)}"
    if passes.camera is not None:
        yield ""
        yield "[camera]"
        yield f"name = {_text(passes.camera.name)}"
        yield f"matrix = {_matrix(passes.camera.matrix)}"
        yield f"error = {_number(passes.camera.error)}"
    yield ""
    yield "[other-lights]"
    yield f"wavelengths = {_row(observer.grid()[[0, -1]])}"
    yield f"projection = {_matrix(passes.light_projection)}"


def _value(value: object) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(_text, value))}]"
    return str(value) if isinstance(value, int) else _text(str(value))


def _text(text: str) -> str:
    """Write a basic string of TOML."""
    return f'"{"".join(map(_escaped, text))}"'


def _escaped(letter: str) -> str:
    is_plain = letter.isprintable() and letter not in '"\\'
    return letter if is_plain else f"\\U{ord(letter):08x}"


def _number(value: float) -> str:
    return repr(float(f"{value:.{DIGITS}g}"))


def _row(values: Sequence[float] | ArrayLike) -> str:
    numbers = np.asarray(values, dtype=float).tolist()
    return f"[{', '.join(map(_number, numbers))}]"


def _matrix(values: ArrayLike) -> str:
    rows = [f"  {_row(row)}," for row in np.asarray(values)]
    return "\n".join(["[", *rows, "]"])


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
    text = f"{_row(passes.bands.centres)} {_number(passes.bands.width)}"
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
