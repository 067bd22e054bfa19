"""The core alone: nine rooms, copied, build a cube, load it and query it."""

import shutil
import subprocess
import sys

CORE = (
    "common",
    "colorimetry",
    "models",
    "lattice",
    "atlas",
    "fit",
    "cube",
    "lookup",
    "pipeline",
)
PROGRAM = """
import sys
from uplift.common.errors import OptionError
from uplift.lookup import load
from uplift.pipeline.build import build
cube = build("macbeth.txt", dim=8)
cube.save("built.uplift")
print(load("built.uplift").reflectance([0.8, 0.2, 0.1], [450, 650]).tolist())
try:
    build("macbeth.txt", dim=8, growth="neighbours")
except OptionError as error:
    print(error.code)
print(*sorted(name for name in sys.modules if name.startswith("uplift.")))
"""
OUTER = ("OpenImageIO", "OpenEXR", "PyOpenColorIO", "jinja2", "pydantic", "click")


def run(folder, program):
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=folder,
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.splitlines()


def test_the_core_alone_builds_loads_and_queries(repository, tmp_path, cyan_cube):
    package = tmp_path / "uplift"
    package.mkdir()
    (package / "__init__.py").touch()
    for room in CORE:
        shutil.copytree(repository / "uplift" / room, package / room)
    shutil.copy(repository / "atlases" / "macbeth.txt", tmp_path)
    program = f"{PROGRAM}\nprint(*set(sys.modules) & {set(OUTER)})"
    answer, code, modules, outer = run(tmp_path, program)

    assert answer == str(cyan_cube.reflectance([0.8, 0.2, 0.1], [450, 650]).tolist())
    assert code == "option"
    assert {name.split(".")[1] for name in modules.split()} == set(CORE)
    assert outer == ""
