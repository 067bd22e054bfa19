"""Compile the code of ``uplift.js`` to WebAssembly: ``make module``.

It needs clang and wasm-ld. tests/extras/export/test_module.py compares the stored code
with its source.
"""

import subprocess
import tempfile
from pathlib import Path

from uplift.extras.export.module import (
    COMPILED,
    SOURCE,
    module_sources,
    source_digest,
)

WIDTH = 8
"""Wavelengths at a time: 16 are a tenth faster for spectra, and slower for four."""
EXPORTS = (
    "uplift_open_memory",
    "uplift_message",
    "uplift_reflectances_n",
    "uplift_standard_error",
    "uplift_error_bound",
    "uplift_coefficient_count",
    "uplift_coefficients",
    "uplift_scratch",
    "uplift_source",
    "malloc",
)
OPTIONS = (
    "--target=wasm32",
    "-Os",
    "-msimd128",
    "-mbulk-memory",
    "-std=c99",
    "-Wall",
    "-Wextra",
    "-nostdlib",
    "-fno-builtin",
    "-isystem.",
    f"-DUPLIFT_WIDTH={WIDTH}",
    "-Wl,--no-entry,--allow-undefined,--stack-first,--strip-all",
    *(f"-Wl,--export={name}" for name in EXPORTS),
)


def compile_module() -> bytes:
    """Return the compiled code. Raise `subprocess.CalledProcessError`."""
    source = f'-DUPLIFT_SOURCE="{source_digest()}"'
    with tempfile.TemporaryDirectory() as folder:
        for name, text in module_sources().items():
            Path(folder, name).write_text(text)
        command = ["clang", *OPTIONS, source, SOURCE, "-o", "module.wasm"]
        subprocess.run(command, cwd=folder, check=True)
        return Path(folder, "module.wasm").read_bytes()


if __name__ == "__main__":
    Path(str(COMPILED)).write_bytes(compile_module())
