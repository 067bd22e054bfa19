"""An emission table as a program for renderers and shaders, in C or GLSL."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from string import Template

from uplift.common.errors import OptionError
from uplift.common.files import atomic_write, check_output
from uplift.io.export.kernel import language, lights
from uplift.io.export.kernel.language import Language
from uplift.io.export.kernel.light_table import LightTable, make_light_table
from uplift.io.export.kernel.program import comment, read_template, table_words, with_numbers
from uplift.io.export.kernel.translate import functions, translate
from uplift.io.export.programs import FORMATS, identifier, write_numbers
from uplift.lights.table import EmissionData, emission_digest

LANGUAGES = {"c": language.C, "glsl": language.GLSL}
"""Languages of `write_light_program`."""
LINE = 27
"""Numbers in a line of a header."""


def write_light_program(
    data: EmissionData,
    path: str | os.PathLike[str],
    *,
    style: str = "c",
    form: str | None = None,
    force: bool = False,
) -> list[Path]:
    """Write an emission table as a program that evaluates it in single precision.

    Names in the program begin with the name of the file, converted to an identifier.

    Parameters
    ----------
    data : EmissionData
        The table.
    path : path-like
        File to write.
    style : {"c", "glsl"}
        Language.
    form : {"header", "file"}, optional
        Where the numbers are: in the program, for C only, the default there; or in a file with the same stem: float32
        numbers, little-endian.
    force : bool
        Whether to replace existing files.

    Returns
    -------
    list of Path
        The files.

    Raises
    ------
    OptionError
        An unknown language (code ``unknown-language``) or form for the language (code ``unknown-table``).
    OutputError
        A file cannot be written, or exists and ``force`` is off.
    """
    if style not in LANGUAGES:
        raise OptionError(
            f"emission tables cannot be written in '{style}'",
            code="unknown-language",
            hint=f"use {' or '.join(LANGUAGES)}",
        )
    path, output = Path(path), FORMATS[style]
    forms = tuple(each for each in output.tables if each != "textures")
    form = form or forms[0]
    if form not in forms:
        raise OptionError(
            f"a program of lights in {style} has no table of the form '{form}'",
            code="unknown-table",
            hint=f"use {' or '.join(forms)}",
        )
    table, numbers = make_light_table(data), path.with_suffix(output.file)
    if form == "file":
        check_output(numbers, force=force)
    program = _Program(data, table, identifier(path.stem), LANGUAGES[style], output.template, form, path.stem)
    text = with_numbers(program.text(), table.numbers, LINE, program.language)
    with (
        atomic_write(path, force=force) as temporary,
        temporary.open("w", encoding="ascii", newline="\n") as opened,
    ):
        opened.writelines(text)
    if form != "file":
        return [path]
    with atomic_write(numbers, force=force) as temporary:
        write_numbers(table.image(), temporary)
    return [path, numbers]


@dataclass(frozen=True, eq=False)
class _Program:
    """Text of a program, as `uplift.io.export.kernel.program.Program` of a cube."""

    data: EmissionData
    table: LightTable
    name: str
    language: Language
    template: str
    form: str
    stem: str

    def text(self) -> str:
        """Return the text, with the word ``${table}`` for the numbers of a header."""
        integers = {key: value for key, value in self.table.constants.items() if isinstance(value, int)}
        words = {
            "digest": emission_digest(self.data),
            "space": comment(self.data.space),
            "observer": comment(self.data.observer),
            "lamps": len(self.data.entries.names),
            "kernel": translate(functions(lights), self.language, self.name, integers),
            **table_words(self.table, self.stem, self.name, self.language),
        }
        # Shaders share the part that reads numbers with programs of cubes; the part for rows is not needed.
        part = "numbers" if read_template(self.template, "numbers") else self.form
        words["access"] = Template(read_template(self.template, part)).safe_substitute(words)
        return Template(read_template(self.template, "lights")).safe_substitute(words)
