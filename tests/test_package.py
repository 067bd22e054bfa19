"""Distributions have the library, the command line and the atlases, and nothing else;
examples run from the wheel.
"""

import re
import zipfile

import pytest

from tests.examples import (
    ELSEWHERE,
    build_distributions,
    examples,
    run_lines,
    source_files,
    unpack,
)
from tools.release import source_problems, wheel_problems
from uplift.common.version import UNKNOWN, VERSION, is_older

BUILT = VERSION + UNKNOWN if VERSION.endswith(".dev") else VERSION
"""Distributions are built from a copy, which is not a clone."""
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
    "uplift lab palette metamers.toml",
    "uplift chart --recommend --time-ns 500",
)
"""Quick ones, in reading order: later lines use files of earlier ones. `make examples`
runs all.
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A source distribution and a wheel, built from a copy that holds no leftovers of
    earlier builds.
    """
    return build_distributions(tmp_path_factory.mktemp("package"))


@pytest.fixture(scope="module")
def wheel(folder):
    return folder / f"spectral_uplift-{BUILT}-py3-none-any.whl"


@pytest.fixture(scope="module")
def tracked(repository):
    return source_files(repository)


def test_the_wheel_has_the_packages_their_data_and_the_licence_alone(
    wheel, tracked, repository
):
    assert wheel_problems(wheel, tracked) == []
    with zipfile.ZipFile(wheel) as archive:
        licence = archive.read(f"spectral_uplift-{BUILT}.dist-info/licenses/LICENSE")
    assert licence == (repository / "LICENSE").read_bytes()


def test_the_source_distribution_has_what_the_wheel_is_built_from(folder, tracked):
    assert source_problems(folder / f"spectral_uplift-{BUILT}.tar.gz", tracked) == []


def test_files_too_many_and_too_few_are_named(wheel, tracked):
    extra = wheel_problems(wheel, set(tracked) - {"uplift/py.typed"})
    assert extra == [f"{wheel.name}: has uplift/py.typed as well"]
    missing = wheel_problems(wheel, [*tracked, "uplift/absent.npz"])
    assert missing == [f"{wheel.name}: lacks uplift/absent.npz"]


def test_a_release_has_its_version_in_all_files(repository):
    """`make release` builds it from any commit, a commit on the way to it included."""
    citation = (repository / "CITATION.cff").read_text("utf-8")
    cited = re.search(r"^version: (.+)$", citation, re.MULTILINE)[1]
    date = re.search(r"^date-released: (.+)$", citation, re.MULTILINE)[1]
    assert f"## {cited} ({date})" in (repository / "CHANGELOG.md").read_text("utf-8")
    if VERSION.endswith(".dev"):
        assert is_older(cited, f"{VERSION}1")
    else:
        assert cited == VERSION


def test_examples_run_as_written_in_an_empty_folder(wheel, tmp_path):
    assert set(FEW) | ELSEWHERE <= set(examples())
    (tmp_path / "empty").mkdir()
    outcomes = run_lines(
        [*FEW, "uplift --version"],
        unpack(wheel, tmp_path / "package"),
        tmp_path / "empty",
    )
    for outcome in outcomes:
        assert outcome["code"] == 0, outcome["line"] + outcome["stderr"]
        assert "error: " not in outcome["stderr"]
    assert outcomes[-1]["stdout"] == f"uplift {BUILT}\n"
