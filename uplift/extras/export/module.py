"""``uplift.js``: a module that reads cube files in JavaScript.

It contains ``uplift.h``, compiled to WebAssembly with the functions of the C library
that it uses. The compiled code is stored, as few machines have the compiler: ``make
module`` writes it, and it states the digest of its source.
"""

import base64
import gzip
import hashlib
from importlib.resources import files
from pathlib import Path
from string import Template

from uplift.common.arrays import StrPath
from uplift.common.files import write_text
from uplift.cube.file import VERSION
from uplift.extras.export.runtime import HEADER, compose_header
from uplift.extras.export.source import read_source

MODULE = "uplift.js"
SOURCE = "module.c"
LIBRARY = ("math.h", "stdlib.h", "string.h")
"""Headers of the C library that ``uplift.h`` includes."""
COMPILED = files("uplift.extras.export") / "source" / "module" / "uplift.wasm"


def export(_: None, path: Path, style: str, *, force: bool) -> str:
    """Write the module."""
    return write_module(path, force=force)


def write_module(path: StrPath, *, force: bool = False) -> str:
    """Write ``uplift.js``, the reader of cube files for JavaScript."""
    text = compose_module()
    write_text(text, Path(path), force=force)
    return f"reads cube files in JavaScript, {len(text) / 1e3:.0f} kB"


def compose_module() -> str:
    """Compose the module: the compiled code, compressed, and functions around it."""
    compressed = gzip.compress(COMPILED.read_bytes(), mtime=0)
    code = base64.b64encode(compressed).decode()
    functions = Template(read_source(f"module/{MODULE}"))
    return functions.safe_substitute(format=VERSION, code=code)


def module_sources() -> dict[str, str]:
    """Return the files that are compiled, by name."""
    library = read_source("module/libc.h")
    sources = dict.fromkeys(LIBRARY, library)
    sources[HEADER] = compose_header()
    sources[SOURCE] = read_source(f"module/{SOURCE}")
    return sources


def source_digest() -> str:
    """Return the SHA-256 of these files."""
    text = "".join(module_sources().values())
    return hashlib.sha256(text.encode()).hexdigest()
