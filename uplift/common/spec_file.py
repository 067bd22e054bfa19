"""TOML and JSON files checked against pydantic models, with errors that name file, line, key and received value.

A model of such a file derives from `SpecModel`. `read_toml` and `read_json` read a file into a `SpecFile`, whose
`validate` returns the model or raises the error type of the caller:

    scene.toml:3: lights[1]: unknown illuminant 'D66'; did you mean 'D65', 'D60', 'D50'?

Only modules that read such files import this one: it loads pydantic.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from pydantic import AfterValidator, BaseModel, ConfigDict, TypeAdapter, ValidationError, model_validator
from pydantic_core import ErrorDetails, PydanticCustomError

from uplift.common.arrays import StrPath
from uplift.common.errors import UpliftError, unknown_name
from uplift.common.input_file import read_bytes
from uplift.common.json_text import TOO_DEEP, InvalidJsonError, check_values, parse_json
from uplift.common.quoting import format_value, shorten

__all__ = [
    "SpecFile",
    "SpecModel",
    "problem",
    "read_json",
    "read_toml",
    "resolves",
]

MAX_BYTES = 16 << 20
"""Largest file that is read."""
HINT = "check the format of the file"
MAX_PROBLEM = 400
"""Characters of a message."""
TYPE_CODES = {
    "literal_error": "invalid-value",
    "unexpected_keyword_argument": "unknown-key",
    "greater_than": "out-of-range",
    "greater_than_equal": "out-of-range",
    "less_than": "out-of-range",
    "less_than_equal": "out-of-range",
    "multiple_of": "out-of-range",
    "finite_number": "out-of-range",
    "too_short": "too-few-items",
    "too_long": "too-many-items",
}
"""Our codes for pydantic's types of errors; all others are of the wrong type."""
CONSTRAINTS = {
    "dataclass_type": "must be a table",
    "dict_type": "must be a table",
    "list_type": "must be a list",
    "model_type": "must be a table",
    "string_type": "must be text in quotes",
    "string_unicode": "must be valid Unicode",
    "unexpected_keyword_argument": "unknown key",
    "too_short": "must have at least {min_length} items",
    "too_long": "must have at most {max_length} items",
}
"""Constraints in terms of the file where pydantic's messages are in terms of Python."""
TAG = "~"
"""First character of the tags of discriminated unions, which are not keys of a file."""

Model = TypeVar("Model")
Key = str | int


class SpecModel(BaseModel):
    """A table of a spec file: frozen, with an error and a suggestion for unknown keys."""

    model_config = ConfigDict(
        extra="forbid",
        frozen=True,
        alias_generator=lambda name: name.replace("_", "-"),
        arbitrary_types_allowed=True,
    )

    @model_validator(mode="before")
    @classmethod
    def _refuse_unknown_keys(cls, values: Any) -> Any:
        if isinstance(values, dict) and cls.model_config.get("extra") == "forbid":
            known = [field.alias or name for name, field in cls.model_fields.items()]
            for key in values:
                if key not in known:
                    raise problem("unknown-key", "unknown key", unknown_name(key, known, "key").hint, key=key)
        return values


def problem(code: str, text: str, hint: str = "", *, key: Key | None = None) -> PydanticCustomError:
    """Return the error that a validator of a `SpecModel` raises.

    Parameters
    ----------
    code : str
        Code of the `UpliftError` that is raised in the end.
    text : str
        The constraint and the value received.
    hint : str
        How to solve the problem.
    key : str or int, optional
        Key below the value being validated that the error belongs to.

    Returns
    -------
    PydanticCustomError
        To be raised.
    """
    context = {"problem": text, "hint": hint, "code": code, "key": key}
    return PydanticCustomError("uplift", "{problem}", context)


def resolves(look_up: Callable[[Any], Any]) -> AfterValidator:
    """Return a validator for names that a function must know.

    Parameters
    ----------
    look_up : callable
        Raises `UpliftError` for names that it does not know; its result is ignored.

    Returns
    -------
    AfterValidator
        For use in ``Annotated``. The value stays as it is.
    """

    def check(value: Any) -> Any:
        try:
            look_up(value)
        except UpliftError as error:
            raise problem(error.code, error.problem, error.hint) from error
        return value

    return AfterValidator(check)


@dataclass(frozen=True)
class SpecFile:
    """A parsed file.

    Parameters
    ----------
    path : Path
        Where it lies.
    text : str
        Its text, to find the lines of keys.
    values : dict
        Its tables and values.
    error : type of UpliftError
        The type of the errors raised.
    """

    path: Path
    text: str
    values: dict[str, Any]
    error: type[UpliftError]

    def validate(self, model: type[Model], hint: str = "") -> Model:
        """Check the values against a model.

        Parameters
        ----------
        model : type
            A `SpecModel`, or any other type that pydantic validates.
        hint : str
            Hint of errors that have none of their own.

        Returns
        -------
        object
            An instance of the model.

        Raises
        ------
        UpliftError
            For the first value that does not fit, of the type of `error`.
        """
        try:
            return TypeAdapter(model).validate_python(self.values)
        except ValidationError as error:
            self._raise(error.errors(include_url=False)[0], hint)

    def fail(self, keys: Iterable[Key], text: str, *, code: str, hint: str = "") -> NoReturn:
        """Raise the error for the value at a key path.

        Parameters
        ----------
        keys : iterable of str or int
            Path of the value; empty for the file.
        text : str
            The constraint and the value received.
        code : str
            Code of the error.
        hint : str
            How to solve the problem.

        Raises
        ------
        UpliftError
            Always.
        """
        path = self._existing(keys)
        where = f"{_dotted(path)}{' ' if text.startswith('must ') else ': '}" if path else ""
        line = _find_line(self.text, path)
        text = _one_line(where + text)
        raise self.error(text, code=code, path=self.path, line=line, hint=hint)

    def line(self, keys: Iterable[Key]) -> int | None:
        """Find the line of a value.

        Parameters
        ----------
        keys : iterable of str or int
            Path of the value.

        Returns
        -------
        int or None
            Line, counted from 1, of the key or of the nearest table around it; None if neither is found.
        """
        return _find_line(self.text, tuple(keys))

    def _existing(self, keys: Iterable[Key]) -> tuple[Key, ...]:
        """Key path without what pydantic adds for unions, keys of tables, and values that are made lists."""
        path: list[Key] = []
        value: Any = self.values
        for key in keys:
            is_key = isinstance(value, dict) and key != "[key]" and not str(key).startswith(TAG)
            if is_key or (isinstance(value, list) and isinstance(key, int)):
                path.append(key)
                value = value.get(key) if isinstance(value, dict) else value[key]
        return tuple(path)

    def _raise(self, details: ErrorDetails, hint: str) -> NoReturn:
        keys = details["loc"]
        context = details.get("ctx", {})
        if details["type"] == "uplift":
            below = () if context["key"] is None else (context["key"],)
            self.fail(keys + below, context["problem"], code=context["code"], hint=context["hint"] or hint)
        if details["type"] == "missing":
            self.fail(keys, "required key is missing", code="missing-key", hint=hint or "add it")
        default = re.sub("^(Input|Value) should", "must", details["msg"])
        constraint = CONSTRAINTS.get(details["type"], default).format_map(context)
        code = TYPE_CODES.get(details["type"], "wrong-type")
        self.fail(keys, f"{constraint}, got {format_value(details['input'])}", code=code, hint=hint)


def read_toml(path: StrPath, error: type[UpliftError]) -> SpecFile:
    """Read a TOML file.

    Parameters
    ----------
    path : path-like
        The file.
    error : type of UpliftError
        The type of the errors raised.

    Returns
    -------
    SpecFile
        Its values, not validated yet.

    Raises
    ------
    UpliftError
        For a file that cannot be read, is too large, nests too deeply or is not TOML.
    """
    text = _read_text(path, error)
    try:
        values = tomllib.loads(text)
        check_values(values)
    except RecursionError:
        raise error(TOO_DEEP, code="nesting-too-deep", path=path, hint=HINT) from None
    except InvalidJsonError as cause:
        raise error(cause.problem, code=cause.code, path=path, hint=HINT) from cause
    except ValueError as cause:  # TOMLDecodeError, and integers of too many digits
        at = re.search(r"at line (\d+)", str(cause))
        line = int(at[1]) if at else max(len(text.splitlines()), 1)
        reason = re.sub(r" \(at .*\)$", "", str(cause)).rstrip(".")
        hint = 'write lines such as key = "value"'
        raise error(f"not a valid TOML file: {reason}", code="invalid-toml", path=path, line=line, hint=hint) from cause
    return SpecFile(Path(path), text, values, error)


def read_json(path: StrPath, error: type[UpliftError]) -> SpecFile:
    """Read a JSON file that holds an object.

    Parameters
    ----------
    path : path-like
        The file.
    error : type of UpliftError
        The type of the errors raised.

    Returns
    -------
    SpecFile
        Its values, not validated yet.

    Raises
    ------
    UpliftError
        For a file that cannot be read, is too large, nests too deeply or is not a JSON object.
    """
    text = _read_text(path, error)
    try:
        values = parse_json(text)
    except InvalidJsonError as cause:
        raise error(
            f"not a valid JSON file: {cause.problem}",
            code=cause.code,
            path=path,
            line=cause.line,
            hint=HINT,
        ) from cause
    if not isinstance(values, dict):
        text = f"not a JSON object: {format_value(values)}"
        raise error(text, code="invalid-json", path=path, hint=HINT)
    return SpecFile(Path(path), "", values, error)


def _one_line(text: str) -> str:
    """Text without control characters, which keys and values of a file may contain."""
    text = re.sub(r"[\x00-\x1f\x7f-\x9f\u2028\u2029]+", " ", text)
    return text if len(text) <= MAX_PROBLEM else f"{text[:MAX_PROBLEM]}…"


def _read_text(path: StrPath, error: type[UpliftError]) -> str:
    data = read_bytes(path, error, limit=MAX_BYTES, hint="check the path")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as cause:
        raise error("not a UTF-8 text file", code="not-utf8", path=path, hint="save it in UTF-8") from cause


def _dotted(keys: tuple[Key, ...]) -> str:
    """Key path as text: ``apart[2].light``."""
    text = ""
    for key in keys:
        text += f"[{key}]" if isinstance(key, int) else f".{shorten(key)}" if text else shorten(key)
    return text


def _find_line(text: str, keys: tuple[Key, ...]) -> int | None:
    """Line of the key, or of the nearest table around it; None if neither is found."""
    best, found = 0, None
    for line, path in _assignments(text):
        shared = 0
        while shared < min(len(path), len(keys)) and path[shared] == keys[shared]:
            shared += 1
        if shared == min(len(path), len(keys)) and shared > best:
            best, found = shared, line
    return found


def _assignments(text: str) -> Iterator[tuple[int, tuple[Key, ...]]]:
    """Line and key path of every table header and assignment that starts a line of TOML."""
    table: tuple[Key, ...] = ()
    counts: dict[tuple[Key, ...], int] = {}
    for line, row in enumerate(text.split("\n"), 1):
        if header := re.match(r"\s*(\[\[?)([^\]=]+)\]", row):
            table = _split(header[2])
            if header[1] == "[[":
                counts[table] = counts.get(table, -1) + 1
                table = (*table, counts[table])
            yield line, table
        elif assignment := re.match(r"""((?:"[^"]*"|'[^']*'|[^=#"'])+)=""", row):
            yield line, table + _split(assignment[1])


def _split(dotted: str) -> tuple[Key, ...]:
    """Parts of a dotted TOML key, without quotes."""
    parts = re.findall(r""""[^"]*"|'[^']*'|[^.\s"']+""", dotted)
    return tuple(part.strip("\"'") for part in parts)
