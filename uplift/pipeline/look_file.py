"""Looks as a TOML file: ``[[look]]`` tables with ``rgb``, a colour for each light, ``weight`` and ``name``."""

from __future__ import annotations

from typing import Any

from uplift.colorimetry.observer import illuminant_spd
from uplift.common.arrays import StrPath
from uplift.common.errors import LookError, UpliftError, unknown_name
from uplift.common.spec_file import SpecFile, read_toml
from uplift.common.text import format_value
from uplift.pipeline.look import Look

TABLE = "look"
NUMBERS = ("weight",)
TEXTS = ("name",)
EXAMPLE = "write [[look]] tables such as rgb = '#8a2a20' and FL11 = '#70392a'"
MAX_LOOKS = 10_000


def read_looks(path: StrPath) -> tuple[Look, ...]:
    """Read a file of looks.

    Parameters
    ----------
    path : path-like
        A TOML file.

    Returns
    -------
    tuple of Look
        The looks, in the order of the file.

    Raises
    ------
    LookError
        A file that cannot be read, or a value that does not fit, with its line.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "looks.toml")
    ...     _ = path.write_text('[[look]]\\nrgb = "#8a2a20"\\nFL11 = "#70392a"\\nname = "brick"\\n')
    ...     [look] = read_looks(path)
    >>> look.name, look.lights
    ('brick', {'FL11': '#70392a'})
    """
    file = read_toml(path, LookError)
    for key in file.values:
        if key != TABLE:
            hint = unknown_name(key, (TABLE,), "key").hint or EXAMPLE
            file.fail((key,), "unknown key", code="unknown-key", hint=hint)
    tables = file.values.get(TABLE, [])
    if not isinstance(tables, list) or not all(isinstance(each, dict) for each in tables):
        file.fail((TABLE,), f"must be tables, got {format_value(tables)}", code="invalid-value", hint=EXAMPLE)
    if not 0 < len(tables) <= MAX_LOOKS:
        file.fail((), f"must have 1 to {MAX_LOOKS} looks, got {len(tables)}", code="no-looks", hint=EXAMPLE)
    return tuple(_look(file, number, table) for number, table in enumerate(tables))


def _look(file: SpecFile, number: int, table: dict[str, Any]) -> Look:
    place = (TABLE, number)
    if "rgb" not in table:
        file.fail(place, "required key 'rgb' is missing", code="missing-key", hint="add rgb = '#8a2a20'")
    for key in TEXTS:
        if not isinstance(table.get(key, ""), str):
            problem = f"must be text in quotes, got {format_value(table[key])}"
            file.fail((*place, key), problem, code="invalid-value", hint="write name = 'brick'")
    lights = {key: value for key, value in table.items() if key not in ("rgb", *NUMBERS, *TEXTS)}
    for light, wish in lights.items():
        if isinstance(wish, dict):
            hint = f'quote names with a dot, such as "{light}.1"'
            file.fail((*place, light), "must be a colour, got a table", code="invalid-value", hint=hint)
        try:
            illuminant_spd(light)
        except UpliftError as error:
            file.fail((*place, light), error.problem, code=error.code, hint=error.hint or EXAMPLE)
    options = {key: table[key] for key in (*NUMBERS, *TEXTS) if key in table}
    return Look(table["rgb"], lights, **options, path=file.path, line=file.line(place))
