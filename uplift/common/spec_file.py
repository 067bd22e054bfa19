"""TOML and JSON files checked against pydantic models, with errors that name file, line, key and received value.

    scene.toml:3: lights[1]: unknown illuminant 'D66'; did you mean 'D65', 'D60', 'D50'?

Only modules that read such files import this one: it loads pydantic.
"""

from __future__ import annotations

import re
import tomllib
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from pydantic import AfterValidator, BaseModel, ConfigDict, TypeAdapter, ValidationError, model_validator
from pydantic_core import ErrorDetails, PydanticCustomError

from uplift.common.arrays import StrPath
from uplift.common.errors import UpliftError, unknown_name
from uplift.common.files import read_bytes
from uplift.common.text import TOO_DEEP, check_values, format_value, parse_json, shorten

__all__ = ["SpecFile", "SpecModel", "problem", "read_json", "read_toml", "resolves"]

MAX_BYTES = 16 << 20
"""Largest file that is read."""
HINT = "check the format of the file"
TAG = "~"
"""First character of the tags of discriminated unions, which are not keys of a file."""

_ASSIGNMENT = re.compile(r"""\s*(\[\[?)?((?:"[^"]*"|'[^']*'|[^][=#"'])+)(?(1)\]|=)""")
"""Start of a line of TOML: a header with its brackets, or a key."""
_PART = re.compile(r""""[^"]*"|'[^']*'|[^.\s"']+""")
"""Part of a dotted key."""

Model = TypeVar("Model")
Key = str | int


class SpecModel(BaseModel):
    """A table of a spec file: frozen, with an error and a suggestion for unknown keys."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, alias_generator=lambda name: name.replace("_", "-"), arbitrary_types_allowed=True
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
    """Return the error that a validator of a `SpecModel` raises; ``key`` is one below the value being validated."""
    return PydanticCustomError("uplift", "{problem}", {"problem": text, "hint": hint, "code": code, "key": key})


def resolves(look_up: Callable[[Any], Any]) -> AfterValidator:
    """Return a validator for names that a function must know, without an `UpliftError`. The value stays as it is."""

    def check(value: Any) -> Any:
        try:
            look_up(value)
        except UpliftError as error:
            raise problem(error.code, error.problem, error.hint) from error
        return value

    return AfterValidator(check)


@dataclass(frozen=True)
class SpecFile:
    """A parsed file: its text, to find the lines of keys, its values, and the type of the errors that it raises."""

    path: Path
    text: str
    values: dict[str, Any]
    error: type[UpliftError]

    def validate(self, model: type[Model], hint: str = "") -> Model:
        """Check the values against a model; the first that does not fit raises `error`, with a default ``hint``."""
        try:
            return TypeAdapter(model).validate_python(self.values)
        except ValidationError as error:
            self._raise(error.errors(include_url=False)[0], hint)

    def fail(self, keys: Iterable[Key], text: str, *, code: str, hint: str = "") -> NoReturn:
        """Raise the error for the value at a key path, empty for the file."""
        path = self._existing(keys)
        where = f"{_dotted(path)}{' ' if text.startswith('must ') else ': '}" if path else ""
        raise self.error(where + text, code=code, path=self.path, line=self.line(path), hint=hint)

    def line(self, keys: Iterable[Key]) -> int | None:
        """Find the line, from 1, of a key or of the nearest table around it; None if neither is found."""
        keys, best, found = tuple(keys), 0, None
        table: tuple[Key, ...] = ()
        counts: Counter[tuple[Key, ...]] = Counter()
        for number, row in enumerate(self.text.split("\n"), 1):
            if not (match := _ASSIGNMENT.match(row)):
                continue
            path: tuple[Key, ...] = tuple(part.strip("\"'") for part in _PART.findall(match[2]))
            if match[1]:
                counts[path] += 1
                path = table = path if match[1] == "[" else (*path, counts[path] - 1)
            else:
                path = table + path
            shared = min(len(path), len(keys))
            if shared > best and path[:shared] == keys[:shared]:
                best, found = shared, number
        return found

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
        keys, context = details["loc"], details.get("ctx", {})
        if details["type"] == "uplift":
            below = () if context["key"] is None else (context["key"],)
            self.fail(keys + below, context["problem"], code=context["code"], hint=context["hint"] or hint)
        if details["type"] == "missing":
            self.fail(keys, "required key is missing", code="missing-key", hint=hint or "add it")
        if details["type"] in ("dict_type", "dataclass_type", "model_type"):
            constraint = "must be a table"
        else:
            constraint = re.sub(r"^\w+ should", "must", details["msg"])
        self.fail(keys, f"{constraint}, got {format_value(details['input'])}", code="invalid-value", hint=hint)


def read_toml(path: StrPath, error: type[UpliftError]) -> SpecFile:
    """Read a TOML file, without validating its values."""
    text = _read_text(path, error)
    try:
        values = tomllib.loads(text)
        check_values(values)
    except (RecursionError, ValueError) as cause:  # TOMLDecodeError, integers of too many digits, and limits
        at = re.search(r"at line (\d+)", str(cause))
        line = int(at[1]) if at else max(len(text.splitlines()), 1)
        reason = TOO_DEEP if isinstance(cause, RecursionError) else re.sub(r" \(at .*\)$", "", str(cause)).rstrip(".")
        hint = 'write lines such as key = "value"'
        raise error(f"not a valid TOML file: {reason}", code="invalid-toml", path=path, line=line, hint=hint) from cause
    return SpecFile(Path(path), text, values, error)


def read_json(path: StrPath, error: type[UpliftError]) -> SpecFile:
    """Read a JSON file that holds an object, without validating its values."""
    text = _read_text(path, error)
    try:
        values = parse_json(text)
    except ValueError as cause:
        line = getattr(cause, "lineno", None)
        problem = f"not a valid JSON file: {cause}"
        raise error(problem, code="invalid-json", path=path, line=line, hint=HINT) from cause
    if not isinstance(values, dict):
        raise error(f"not a JSON object: {format_value(values)}", code="invalid-json", path=path, hint=HINT)
    return SpecFile(Path(path), "", values, error)


def _read_text(path: StrPath, error: type[UpliftError]) -> str:
    try:
        return read_bytes(path, error, limit=MAX_BYTES, hint="check the path").decode("utf-8")
    except UnicodeDecodeError as cause:
        raise error("not a UTF-8 text file", code="file-unreadable", path=path, hint="save it in UTF-8") from cause


def _dotted(keys: tuple[Key, ...]) -> str:
    """Key path as text: ``apart[2].light``."""
    text = "".join(f"[{key}]" if isinstance(key, int) else f".{shorten(key)}" for key in keys)
    return text.removeprefix(".")
