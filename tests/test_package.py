"""The wheel holds the library, the command line, the default cube and the atlases, and nothing else."""

import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

import uplift
from tests.examples import build_wheel, source_files
from uplift.common.version import DISTRIBUTION

FOLDERS = {"uplift": "uplift", "cli": "uplift_cli", "atlases": "uplift_atlases"}
INFO = f"{DISTRIBUTION.replace('-', '_')}-{uplift.__version__}.dist-info"


@pytest.fixture(scope="module")
def wheel(repository, tmp_path_factory):
    """Built once a run, from a copy that holds no leftovers of earlier builds."""
    path = build_wheel(tmp_path_factory.mktemp("package"))
    with zipfile.ZipFile(path) as archive:
        yield archive


def info(wheel, name):
    return wheel.read(f"{INFO}/{name}").decode()


def test_every_module_is_in_it(wheel, repository):
    for here, there in FOLDERS.items():
        modules = [path.relative_to(repository / here).as_posix() for path in (repository / here).rglob("*.py")]
        assert len(modules) > 10 or here == "atlases"
        assert {f"{there}/{module}" for module in modules} <= set(wheel.namelist())


def test_data_marker_and_licence_are_in_it(wheel, repository):
    for name in ("uplift/lookup/default.uplift", "uplift/lights/emission.uplift", "uplift/py.typed"):
        assert wheel.read(name) == (repository / name).read_bytes()
    assert info(wheel, "licenses/LICENSE") == (repository / "LICENSE").read_text(encoding="utf-8")


def test_nothing_else_is_in_it(wheel, repository):
    assert {name.split("/")[0] for name in wheel.namelist()} == {"uplift", "uplift_atlases", "uplift_cli", INFO}
    data = {name for name in wheel.namelist() if ".dist-info/" not in name and not name.endswith(".py")}
    tracked = {name for name in source_files(repository) if not name.endswith(".py")}
    library = {name for name in tracked if name.startswith("uplift/")}
    atlases = {f"uplift_{name}" for name in tracked if name.startswith("atlases/")}
    assert data == library | atlases
    suffixes = ".c .cpp .css .csv .cxf .cuh .exr .glsl .h .hlsl .j2 .js .npz .png .ti3 .toml .typed .uplift .xlsx"
    assert {Path(name).suffix for name in library} == set(suffixes.split())
    assert {Path(name).suffix for name in atlases} == {".md", ".txt"}


def test_it_works_from_where_it_is_installed(wheel, tmp_path):
    wheel.extractall(tmp_path)
    code = (
        f"import sys; sys.path.insert(0, {str(tmp_path)!r}); import uplift, uplift_cli.main as cli\n"
        f"assert uplift.__file__.startswith({str(tmp_path)!r}) and cli.__file__.startswith({str(tmp_path)!r})\n"
        "from uplift.atlas import shipped_atlases\n"
        f"assert all(str(atlas.path).startswith({str(tmp_path)!r}) for atlas in shipped_atlases())\n"
        "assert len(uplift.read_atlas('macbeth')) == 24\n"
        "cli.main(['query', '#ffffff', '--format', 'csv', '--wavelengths', '550'])"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert done.stdout.startswith("r,g,b,delta_e_2000,standard_error,error_bound,entry,550\n1.0,1.0,1.0,")
