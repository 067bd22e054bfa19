"""The wheel holds what is needed to run, and nothing else."""

from __future__ import annotations

import shutil
import subprocess
import sys
import zipfile

import pytest

from .conftest import ROOT


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """The names in a wheel built from a copy of what a checkout holds, and the archive."""
    source = tmp_path_factory.mktemp("source")
    for folder in ("uplift", "cli"):
        shutil.copytree(ROOT / folder, source / folder, ignore=shutil.ignore_patterns("__pycache__"))
    for file in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copyfile(ROOT / file, source / file)
    for folder in ("tests", "cubes", "atlases"):
        (source / folder).mkdir()
        (source / folder / "__init__.py").touch()
    command = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", "dist"]
    subprocess.run(command, cwd=source, capture_output=True, check=True)
    (path,) = (source / "dist").glob("*.whl")
    with zipfile.ZipFile(path) as archive:
        yield archive


def test_every_module_is_in_it(wheel):
    expected = {str(path.relative_to(ROOT)) for path in (ROOT / "uplift").rglob("*.py")}
    expected |= {f"uplift_{path.relative_to(ROOT)}" for path in (ROOT / "cli").rglob("*.py")}
    assert expected <= set(wheel.namelist())


def test_the_default_cube_the_types_and_the_licence_are_in_it(wheel):
    names = wheel.namelist()
    assert "uplift/lookup/default.uplift" in names
    assert "uplift/py.typed" in names
    assert any(name.endswith("licenses/LICENSE") for name in names)


def test_nothing_else_is_in_it(wheel):
    tops = {name.split("/")[0] for name in wheel.namelist() if ".dist-info/" not in name}
    assert tops == {"uplift", "uplift_cli"}
    assert sum(info.file_size for info in wheel.infolist()) < 2e6


def test_the_console_script_is_named(wheel):
    (name,) = (name for name in wheel.namelist() if name.endswith("entry_points.txt"))
    assert "uplift = uplift_cli.main:main" in wheel.read(name).decode()


def test_it_answers_from_the_wheel_alone(wheel):
    code = (
        f"import sys; sys.path.insert(0, {wheel.filename!r}); import uplift\n"
        "assert '.whl' in uplift.__file__, uplift.__file__\n"
        "print(uplift.load().reflectance([0.1, 0.2, 0.3]).shape)"
    )
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout == "(81,)\n"
