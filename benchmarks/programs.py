"""Programs that pages compile and run: C next to exported headers, Node.js, scripts."""

import subprocess
from pathlib import Path

Words = str | Path


def compile_c(
    source: Path, folder: Path, *flags: str, compiler: str = "cc", name: str = ""
) -> Path:
    """Compile a C file with the headers of a folder; return the program, which is in
    the folder, by default with the name of the file.
    """
    program = folder / (name or source.stem)
    command = [compiler, *flags, f"-I{folder}", source, "-o", program, "-lm"]
    subprocess.run(command, check=True)
    return program


def output(*command: Words, folder: Path | None = None, given: bytes = b"") -> bytes:
    """Run a command in a folder with standard input; return its standard output."""
    return subprocess.run(
        command, cwd=folder, input=given, stdout=subprocess.PIPE, check=True
    ).stdout


def numbers(*command: Words, folder: Path | None = None) -> list[float]:
    """Run a command in a folder; return the numbers that it prints."""
    return [float(word) for word in output(*command, folder=folder).split()]


def program_version(program: str) -> str:
    """Return the version that a program states."""
    return output(program, "--version").decode().splitlines()[0]
