"""SCENE.toml: what is to be rendered, under which lights, and how far colours may be off."""

from __future__ import annotations

import glob
import os
import re
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from uplift.colorimetry import observer
from uplift.colorimetry.lights import DEFAULT_ILLUMINANT, SCENE_LIGHTS
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.errors import PlanFileError, UpliftError, unknown_name
from uplift.io.texture.colours import check_encoding

LEAST, MOST = 0.01, 100.0
"""Tolerances that mean anything, ΔE00."""
LONGEST = 4096
"""Letters of a path; patterns that are longer take minutes."""
EXAMPLE = 'textures = ["wood.png"]'


@dataclass(frozen=True)
class SceneFile:
    """What a scene file says; paths lie where it lies.

    Parameters
    ----------
    textures : images whose colours are uplifted.
    atlases : files of measured spectra that the textures are painted from.
    lights : illuminants that the scene is seen under.
    tolerance, quantile : the ΔE00 that this share of the textures' pixels, and of the atlas's entries, stay within
        under every light.
    encoding, space, illuminant, observer : what the textures' numbers mean.
    """

    path: Path
    textures: tuple[Path, ...]
    atlases: tuple[Path, ...] = ()
    lights: tuple[str, ...] = SCENE_LIGHTS
    tolerance: float = 1.0
    quantile: float = 0.975
    encoding: str = "auto"
    space: str = "sRGB"
    illuminant: str = DEFAULT_ILLUMINANT
    observer: str = observer.DEFAULT_OBSERVER

    def sensor(self) -> Sensor:
        return observer.sensor(self.space, self.illuminant, self.observer)

    def light_sources(self) -> tuple[Light, ...]:
        return tuple(observer.light(name, self.observer) for name in self.lights)


def read_scene_file(path: str | os.PathLike[str]) -> SceneFile:
    """Raises `PlanFileError` with the line and the hint."""
    text = _text(Path(path))
    try:
        said = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        at = re.search(r"at line (\d+)", str(error))
        line = int(at[1]) if at else max(len(text.splitlines()), 1)  # or at the end of the document
        problem = re.sub(r" \(at .*\)$", "", str(error)).rstrip(".")
        hint = f"write lines such as {EXAMPLE}"
        raise PlanFileError(f"is no TOML: {problem}", path=path, line=line, hint=hint) from error
    except RecursionError as error:
        raise PlanFileError("nests too deeply", path=path, hint=f"write lines such as {EXAMPLE}") from error
    return _Reader(Path(path), text, said).scene()


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        problem = f"cannot be read: {error.strerror or error}"
        raise PlanFileError(problem, path=path, hint="name a scene file, SCENE.toml") from error
    except UnicodeDecodeError as error:
        raise PlanFileError("is no text", path=path, hint="write it in UTF-8") from error


@dataclass(frozen=True)
class _Reader:
    """The file as it was read, and what its keys must be."""

    path: Path
    text: str
    said: Mapping[str, Any]

    def scene(self) -> SceneFile:
        readers: dict[str, Callable[[str], Any]] = {
            "textures": self._files,
            "atlases": self._files,
            "lights": self._lights,
            "tolerance": lambda key: self._number(key, LEAST, MOST),
            "quantile": lambda key: self._number(key, 0.5, 1.0),
            **dict.fromkeys(("encoding", "space", "illuminant", "observer"), self._word),
        }
        for key in self.said.keys() - readers.keys():
            self._raise(key, unknown_name(key, readers, "key"))
        if "textures" not in self.said:
            hint = f"add a line such as {EXAMPLE}"
            raise PlanFileError("names no textures, so there are no colours", path=self.path, hint=hint)
        found = SceneFile(self.path, **{key: readers[key](key) for key in self.said})
        self._check(found)
        return found

    def _check(self, found: SceneFile) -> None:
        """Names that only the tables know."""
        checks: dict[str, Callable[[], Any]] = {
            "encoding": lambda: check_encoding(found.encoding),
            "space": lambda: observer.sensor(found.space),
            "illuminant": lambda: observer.illuminant_spd(found.illuminant),
            "observer": lambda: observer.matching_functions(found.observer),
        }
        for key, check in checks.items():
            try:
                check()
            except UpliftError as error:
                self._raise(key, error)

    def _files(self, key: str) -> tuple[Path, ...]:
        paths = tuple(path for name in self._texts(key) for path in self._named(key, name))
        if missing := [path for path in paths if not os.path.isfile(path)]:
            self._fail(
                key, f"{key}: there is no file {missing[0]}", "paths are taken from the scene file's folder"
            )
        return paths

    def _named(self, key: str, name: str) -> list[Path]:
        """A file, or all that a pattern fits."""
        folder = self.path.parent
        if len(name) > LONGEST or "\0" in name:
            self._fail(key, f"{key}: '{name[:20]}…' is no path", "name a file, or a pattern")
        if os.path.exists(folder / name) or not glob.has_magic(name):
            return [folder / name]
        found = sorted(glob.glob(name, root_dir=folder))
        if not found:
            self._fail(key, f"{key}: no file is named like '{name}'", "check the pattern")
        return [folder / each for each in found]

    def _lights(self, key: str) -> tuple[str, ...]:
        """By the names that the tables have, each once."""
        names = self._texts(key)
        try:
            return tuple(dict.fromkeys(observer.light(name).name for name in names))
        except UpliftError as error:
            self._raise(key, error)

    def _texts(self, key: str) -> list[str]:
        value = self.said[key]
        texts = [value] if isinstance(value, str) else value
        if not (isinstance(texts, list) and texts and all(isinstance(text, str) and text for text in texts)):
            self._fail(key, f"{key} is no list of names", f'write {key} = ["…", "…"]')
        return texts

    def _number(self, key: str, least: float, most: float) -> float:
        value = self.said[key]
        if isinstance(value, bool) or not isinstance(value, int | float) or not least <= value <= most:
            self._fail(
                key,
                f"{key} is no number from {least:g} to {most:g}",
                f"write {key} = {getattr(SceneFile, key)}",
            )
        return float(value)

    def _word(self, key: str) -> str:
        if not isinstance(self.said[key], str):
            self._fail(key, f"{key} is no name", f'write {key} = "{getattr(SceneFile, key)}"')
        return str(self.said[key])

    def _fail(self, key: str, problem: str, hint: str) -> NoReturn:
        raise PlanFileError(problem, path=self.path, line=self._line(key), hint=hint)

    def _raise(self, key: str, error: UpliftError) -> NoReturn:
        """The same error, with its place."""
        raise PlanFileError(error.problem, path=self.path, line=self._line(key), hint=error.hint) from error

    def _line(self, key: str) -> int | None:
        """Where a key stands."""
        lines = enumerate(self.text.splitlines(), 1)
        pattern = re.compile(rf"""\s*\[*["']?{re.escape(key)}\b""")
        return next((number for number, line in lines if pattern.match(line)), None)
