"""The wheel has the library, the command line and the atlases, and nothing else;
examples run from it.
"""

import zipfile
from pathlib import Path

import pytest

from tests.examples import (
    ELSEWHERE,
    build_wheel,
    examples,
    run_lines,
    source_files,
    unpack,
)
from uplift.common.version import UNKNOWN, VERSION

FOLDERS = {"uplift": "uplift", "cli": "uplift_cli", "atlases": "uplift_atlases"}
INFO = f"spectral_uplift-{VERSION}{UNKNOWN}.dist-info"
"""The wheel is built from a copy, which is not a clone."""
FEW = (
    "uplift samples",
    "cd uplift-samples",
    "uplift relight wood.png -o wood.html",
    "uplift build --atlas macbeth --dim 32",
    (
        "uplift query --cube macbeth-32.uplift --input colours.csv --format csv --mode "
        "refined > spectra.csv"
    ),
    "uplift texture wood.png -o wood.exr",
    "uplift export macbeth-32.uplift -o cube.h",
    "uplift lights query 30 22 9",
    "uplift info macbeth-32.uplift --format json | jq .status",
    "uplift atlas paints.csv -o paints.txt",
    "uplift palette metamers.toml",
    "uplift chart --recommend --time-ns 500",
)
"""Quick ones, in reading order: later lines use files of earlier ones. `make examples`
runs all.
"""


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    """Built from a copy that holds no leftovers of earlier builds."""
    return build_wheel(tmp_path_factory.mktemp("package"))


@pytest.fixture
def wheel(path):
    with zipfile.ZipFile(path) as archive:
        yield archive


def test_every_module_is_in_it(wheel, repository):
    for here, there in FOLDERS.items():
        modules = [
            path.relative_to(repository / here).as_posix()
            for path in (repository / here).rglob("*.py")
        ]
        assert len(modules) > 10 or here == "atlases"
        assert {f"{there}/{module}" for module in modules} <= set(wheel.namelist())


def is_data(path):
    return path.suffix != ".py" and path.parts[0] != INFO


def test_data_and_licence_are_in_it_and_nothing_else(wheel, repository):
    licence = wheel.read(f"{INFO}/licenses/LICENSE")
    assert licence == (repository / "LICENSE").read_bytes()
    names = set(map(Path, wheel.namelist()))
    assert {name.parts[0] for name in names} == {*FOLDERS.values(), INFO}
    tracked = source_files(repository)
    library = {Path(name) for name in tracked if name.startswith("uplift/")}
    atlases = {
        Path(f"uplift_{name}") for name in tracked if name.startswith("atlases/")
    }
    assert set(filter(is_data, names)) == set(filter(is_data, library | atlases))
    suffixes = (
        ".c .cpp .css .csv .cxf .cuh .exr .glsl .h .hlsl .j2 .js .npz .png .spd .ti3 "
        ".toml .typed .uplift .wasm .xlsx"
    )
    assert {name.suffix for name in library} == {".py", *suffixes.split()}
    assert {name.suffix for name in atlases} == {".md", ".py", ".txt"}


def test_examples_run_as_written_in_an_empty_folder(path, tmp_path):
    assert set(FEW) | ELSEWHERE <= set(examples())
    (tmp_path / "empty").mkdir()
    outcomes = run_lines(
        [*FEW, "uplift --version"],
        unpack(path, tmp_path / "package"),
        tmp_path / "empty",
    )
    for outcome in outcomes:
        assert outcome["code"] == 0, outcome["line"] + outcome["stderr"]
        assert "error: " not in outcome["stderr"]
    assert outcomes[-1]["stdout"] == f"uplift {VERSION}{UNKNOWN}\n"
