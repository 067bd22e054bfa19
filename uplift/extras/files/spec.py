"""Specifications: TOML and JSON files as pydantic models, with errors that name file,
key and received value.

    scene.toml: lights[1]: unknown illuminant 'D66'; did you mean 'D65', 'D60', 'D50'?

Validators find the files that a specification names by `file_in_folder`. Only modules
that read such files import this one: it loads pydantic.
"""

import contextlib
import re
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path, PureWindowsPath
from typing import Annotated, Any, TypeVar

import numpy as np
from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    GetPydanticSchema,
    PlainValidator,
    TypeAdapter,
    ValidationError,
    ValidationInfo,
)
from pydantic_core import InitErrorDetails, PydanticCustomError, core_schema

from uplift.common.arrays import Array, StrPath
from uplift.common.errors import UpliftError
from uplift.common.files import decode_text, read_bytes
from uplift.common.text import (
    MAX_DEPTH,
    TOO_DEEP,
    check_values,
    format_value,
    parse_json,
    shorten,
)

MAX_BYTES = 16 << 20
"""Largest file that is read."""
MAX_PATH = 4096
"""Characters of a path. Matching longer patterns takes minutes."""
HINT = "check the format of the file"
INVALID = "invalid-file"
"""Code of errors in the text of a file: its syntax, its keys, or a value."""
UNKNOWN_KEY = ("extra_forbidden", "unexpected_keyword_argument")
"""Types of errors: of models, and of dataclasses."""
TEXTS = {
    "missing": "required key is missing",
    **dict.fromkeys(UNKNOWN_KEY, "unknown key"),
    **dict.fromkeys(("dataclass_type", "model_type"), "must be a table"),
}
"""Problems by the type of an error of pydantic whose message speaks of Python."""
STRING_OR_COMMENT = re.compile(
    r'''"""(?:\\.|[^\\])*?"""|\'{3}.*?\'{3}|"(?:\\.|[^"\\\n])*"|'[^'\n]*'|\#[^\n]*''',
    re.DOTALL,
)
"""Parts of TOML in which points separate nothing."""
DEEP_KEY = re.compile(rf"(?<![\w-])(?:[\w-]+[ \t]*\.[ \t]*){{{MAX_DEPTH}}}")
"""Dotted keys of more than `MAX_DEPTH` parts."""
TAG = "~"
"""First character of the tags of discriminated unions, which are not keys of a file."""

Model = TypeVar("Model")
Key = str | int


def kebab_case(name: str) -> str:
    """Return the key of a field."""
    return name.replace("_", "-")


SPEC = ConfigDict(
    extra="forbid",
    frozen=True,
    alias_generator=kebab_case,
    arbitrary_types_allowed=True,
)
"""Configuration of tables, also of dataclasses by ``__pydantic_config__``: no other
keys than the fields, with hyphens.
"""


class SpecModel(BaseModel):
    """A frozen table of a specification."""

    model_config = SPEC


@dataclass(frozen=True)
class SpecFolder:
    """Folder of a specification, and the files there that its validators opened."""

    path: Path
    opened: list[Path] = field(default_factory=list)


def problem(
    text: str, hint: str = "", code: str = INVALID, *, at: tuple[Key, ...] = ()
) -> ValidationError:
    """Return the error that a validator raises, for its value or for one at keys below
    it.
    """
    context = {"problem": text, "hint": hint, "code": code}
    error = PydanticCustomError("uplift", "{problem}", context)
    details = InitErrorDetails(type=error, loc=at, input=None)
    return ValidationError.from_exception_data("", [details])


@contextlib.contextmanager
def looking_up(*at: Key) -> Iterator[None]:
    """Raise an `UpliftError` as the `problem` of the value that is validated, or of one
    at keys below it. Its code stays.
    """
    try:
        yield
    except UpliftError as error:
        text = error.describe("")  # with its own place, such as a line of a lamp
        raise problem(text, error.hint, error.code, at=at) from error


def resolves(look_up: Callable[[Any], object]) -> AfterValidator:
    """Return a validator for names that a function must know, without an `UpliftError`.
    The value stays as it is.
    """

    def check(value: Any) -> Any:
        with looking_up():
            look_up(value)
        return value

    return AfterValidator(check)


def check_shape(values: Array, shape: tuple[int, ...], *at: Key) -> None:
    """Check the shape of an array at keys below the value that is validated."""
    if values.shape != shape:
        expected, got = (" × ".join(map(str, size)) for size in (shape, values.shape))
        raise problem(f"must be {expected} numbers, got {got}", at=at)


def check_inside(name: Any, *at: Key) -> str:
    """Check that a path lies within the folder of its specification, which may come
    from a stranger.
    """
    if not isinstance(name, str) or not 0 < len(name) <= MAX_PATH or "\0" in name:
        text = f"must be a path of 1 to {MAX_PATH} characters without null bytes"
        raise problem(f"{text}, got {format_value(name)}", "name a file", at=at)
    path = PureWindowsPath(name)  # of POSIX, too
    if path.anchor or ".." in path.parts:
        text = f"must lie in the folder of this file, got {format_value(name)}"
        hint = "move the file there, or this file to a folder above both"
        raise problem(text, hint, at=at)
    return name


def spec_folder(info: ValidationInfo) -> SpecFolder:
    """Return the folder of the specification that is validated."""
    folder: SpecFolder = info.context or SpecFolder(Path())
    return folder


def file_in_folder(name: Any, info: ValidationInfo) -> Path:
    """Return the path of a file that is named in a specification."""
    folder = spec_folder(info)
    path = folder.path / check_inside(name)
    folder.opened.append(path)
    return path


FolderPath = Annotated[Path, PlainValidator(file_in_folder)]
"""A file within the folder of the specification."""
Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
NotNegative = Annotated[Number, Field(ge=0)]


def _array_of(lists: Any) -> GetPydanticSchema:
    """Return the schema of an array that a file has as lists."""
    make = core_schema.no_info_after_validator_function
    return GetPydanticSchema(lambda _, handler: make(_as_array, handler(lists)))


def _as_array(values: list[Any]) -> Array:
    if len({np.shape(value) for value in values}) > 1:
        raise problem("must have rows of one length")
    return np.array(values)


Row = Annotated[Array, _array_of(list[Number])]
"""Finite numbers (n,)."""
NotNegativeRow = Annotated[Array, _array_of(list[NotNegative])]
Matrix = Annotated[Array, _array_of(list[list[Number]])]
"""Finite numbers (m, n)."""


def read_spec(
    path: StrPath,
    model: type[Model],
    error: type[UpliftError],
    *,
    kind: str = "TOML",
    hint: str = HINT,
    given: Mapping[str, object] | None = None,
    folder: SpecFolder | None = None,
) -> Model:
    """Read a file of a ``kind`` of `PARSERS` as a model, or as a dataclass.

    The first value that does not fit raises ``error``, with ``hint`` unless it has its
    own.
    ``given`` are values of fields that the file must not have. The ``folder``, by
    default that of the file, is the context of validators.
    """
    values = {**(given or {}), **_read(path, error, kind)}
    context = folder or SpecFolder(Path(path).parent)
    try:
        return TypeAdapter(model).validate_python(values, context=context)
    except ValidationError as caught:
        raise _located(caught, path, error, hint) from caught


def _read(path: StrPath, error: type[UpliftError], kind: str) -> dict[str, Any]:
    data = read_bytes(path, error, limit=MAX_BYTES, hint="check the path")
    try:
        values = PARSERS[kind](decode_text(data))
        check_values(values)
        if not isinstance(values, dict):
            raise ValueError(f"not an object: {format_value(values)}")
    except (RecursionError, ValueError) as cause:  # of UTF-8, syntax and limits
        reason = TOO_DEEP if isinstance(cause, RecursionError) else cause
        text = f"not a valid {kind} file: {reason}"
        raise error(text, code=INVALID, path=path, hint=HINT) from cause
    return values


def _parse_toml(text: str) -> dict[str, Any]:
    """Parse TOML without long dotted keys, for which tomllib takes memory in the square
    of their length.
    """
    if DEEP_KEY.search(STRING_OR_COMMENT.sub("_", text)):
        raise ValueError(TOO_DEEP)
    return tomllib.loads(text)


PARSERS: Mapping[str, Callable[[str], Any]] = {"TOML": _parse_toml, "JSON": parse_json}


def _located(
    caught: ValidationError, path: StrPath, error: type[UpliftError], hint: str
) -> UpliftError:
    """Return the error for one of the values that do not fit."""
    faults = caught.errors(include_url=False)
    # An unknown key may be a misspelt one, which is missing.
    unknown = [fault for fault in faults if fault["type"] in UNKNOWN_KEY]
    fault = (unknown or faults)[0]
    context = fault.get("ctx", {})
    text = TEXTS.get(fault["type"]) or re.sub("^Input should", "must", fault["msg"])
    if text.startswith("must") and "problem" not in context:
        text = f"{text}, got {format_value(fault['input'])}"
    place = _place(fault["loc"])
    separator = " " if text.startswith("must ") else ": "
    return error(
        f"{place}{separator}{text}" if place else text,
        code=context.get("code", INVALID),
        path=path,
        hint=context.get("hint") or hint,
    )


def _place(keys: Iterable[Key]) -> str:
    """Write a key path such as ``apart[2].light``; empty for the file."""
    # Left out of the path: what pydantic adds for unions and for keys of tables
    parts = [key for key in keys if key != "[key]" and not str(key).startswith(TAG)]
    names = [
        f"[{key}]" if isinstance(key, int) else f".{shorten(key)}" for key in parts
    ]
    return "".join(names).removeprefix(".")
