"""TOML and JSON files checked against pydantic models, with errors that name file, key
and received value.

    scene.toml: lights[1]: unknown illuminant 'D66'; did you mean 'D65', 'D60', 'D50'?

Only modules that read such files import this one: it loads pydantic.
"""

import re
import tomllib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path, PureWindowsPath
from typing import Annotated, Any, NoReturn, TypeVar

from pydantic import AfterValidator, BaseModel, ConfigDict, TypeAdapter, ValidationError
from pydantic_core import PydanticCustomError

from uplift.common.arrays import StrPath
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
HINT = "check the format of the file"
INVALID = "invalid-file"
"""Code of errors in the text of a file: its syntax, its keys, or a value."""
UNKNOWN_KEY = ("extra_forbidden", "unexpected_keyword_argument")
"""Types of errors: of models, and of dataclasses."""
TEXTS = {
    "missing": "required key is missing",
    **dict.fromkeys(UNKNOWN_KEY, "unknown key"),
} | dict.fromkeys(("dict_type", "dataclass_type", "model_type"), "must be a table")
"""Problems by the type of an error of pydantic, in place of its message."""
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


class SpecModel(BaseModel):
    """A table of a spec file: frozen, without other keys than its fields."""

    model_config = ConfigDict(
        extra="forbid",
        frozen=True,
        alias_generator=lambda name: name.replace("_", "-"),
        arbitrary_types_allowed=True,
    )


def problem(text: str, hint: str = "", code: str = INVALID) -> PydanticCustomError:
    """Return the error that a validator of a `SpecModel` raises."""
    return PydanticCustomError(
        "uplift", "{problem}", {"problem": text, "hint": hint, "code": code}
    )


def resolves(look_up: Callable[[Any], Any]) -> AfterValidator:
    """Return a validator for names that a function must know, without an `UpliftError`.
    The value stays as it is.
    """

    def check(value: Any) -> Any:
        try:
            look_up(value)
        except UpliftError as error:
            raise problem(error.problem, error.hint, error.code) from error
        return value

    return AfterValidator(check)


def check_inside(name: str) -> str:
    """Check that a path lies within the folder of its spec file, which may come from a
    stranger.
    """
    if (
        PureWindowsPath(name).anchor or ".." in PureWindowsPath(name).parts
    ):  # of POSIX, too
        hint = "move the file there, or this file to a folder above both"
        raise problem(
            f"must lie in the folder of this file, got {format_value(name)}", hint
        )
    return name


InsidePath = Annotated[str, AfterValidator(check_inside)]
"""A path within the folder of the spec file."""


@dataclass(frozen=True)
class SpecFile:
    """The values of a parsed file, and the type of the errors that it raises."""

    path: Path
    values: dict[str, Any]
    error: type[UpliftError]

    def validate(self, model: type[Model], hint: str = "") -> Model:
        """Check the values against a model; the first that does not fit raises `error`,
        with ``hint`` or its own.
        """
        try:
            return TypeAdapter(model).validate_python(self.values)
        except ValidationError as caught:
            errors = caught.errors(include_url=False)
            # An unknown key may be a misspelt one, which is missing.
            error = next(
                (each for each in errors if each["type"] in UNKNOWN_KEY), errors[0]
            )
            context = error.get("ctx", {})
            kind = error["type"]
            text = TEXTS.get(kind) or re.sub(r"^\w+ should", "must", error["msg"])
            if kind != "uplift" and text.startswith("must"):
                text = f"{text}, got {format_value(error['input'])}"
            self.fail(
                error["loc"],
                text,
                code=context.get("code", INVALID),
                hint=hint or context.get("hint", ""),
            )

    def fail(
        self, keys: Iterable[Key], text: str, *, code: str = INVALID, hint: str = ""
    ) -> NoReturn:
        """Raise the error for the value at a key path such as ``apart[2].light``, empty
        for the file.
        """
        # Left out of the path: what pydantic adds for unions and for keys of tables
        parts = [key for key in keys if key != "[key]" and not str(key).startswith(TAG)]
        place = "".join(
            f"[{key}]" if isinstance(key, int) else f".{shorten(key)}" for key in parts
        )
        separator = " " if text.startswith("must ") else ": "
        text = f"{place.removeprefix('.')}{separator}{text}" if place else text
        raise self.error(text, code=code, path=self.path, hint=hint)


def read_toml(path: StrPath, error: type[UpliftError]) -> SpecFile:
    """Read a TOML file, without validating its values."""
    return _read(path, error, "TOML", _parse_toml)


def _parse_toml(text: str) -> dict[str, Any]:
    """Parse TOML without long dotted keys, for which tomllib takes memory in the square
    of their length.
    """
    if DEEP_KEY.search(STRING_OR_COMMENT.sub("_", text)):
        raise ValueError(TOO_DEEP)
    return tomllib.loads(text)


def read_json(path: StrPath, error: type[UpliftError]) -> SpecFile:
    """Read a JSON file that holds an object, without validating its values."""
    return _read(path, error, "JSON", parse_json)


def _read(
    path: StrPath, error: type[UpliftError], kind: str, parse: Callable[[str], Any]
) -> SpecFile:
    data = read_bytes(path, error, limit=MAX_BYTES, hint="check the path")
    try:
        values = parse(decode_text(data))
        check_values(values)
    except (
        RecursionError,
        ValueError,
    ) as cause:  # of UTF-8, syntax, integers of too many digits, and limits
        reason = TOO_DEEP if isinstance(cause, RecursionError) else cause
        raise error(
            f"not a valid {kind} file: {reason}", code=INVALID, path=path, hint=HINT
        ) from cause
    if not isinstance(values, dict):
        raise error(
            f"not a JSON object: {format_value(values)}",
            code=INVALID,
            path=path,
            hint=HINT,
        )
    return SpecFile(Path(path), values, error)
