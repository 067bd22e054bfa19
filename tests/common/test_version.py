"""The version: of a commit in a clone, of its build in a distribution, and unknown
elsewhere.
"""

import shutil
import subprocess

import pytest

from uplift.common import version
from uplift.common.version import UNKNOWN, VERSION, is_older


@pytest.fixture
def version_of(monkeypatch):
    """The version of the source in a folder."""

    def version_of(folder):
        monkeypatch.setattr(version, "ROOT", folder)
        return version.version.__wrapped__()

    return version_of


@pytest.mark.skipif(shutil.which("git") is None, reason="no git")
def test_every_commit_has_a_version_that_a_shallow_clone_does_not_know(
    version_of, tmp_path
):
    def git(*arguments):
        identity = (
            "-c",
            "user.name=a",
            "-c",
            "user.email=a@b.c",
            "-c",
            "commit.gpgsign=false",
        )
        subprocess.run(
            ["git", *identity, *arguments],
            cwd=tmp_path,
            check=True,
            capture_output=True,
        )

    git("init")
    for count in (1, 2):
        git("commit", "--allow-empty", "-m", "change")
        assert version_of(tmp_path) == f"{VERSION}{count}"
    git("clone", "--depth", "1", tmp_path.as_uri(), "shallow")
    assert version_of(tmp_path / "shallow") == VERSION + UNKNOWN


def test_a_source_distribution_has_the_version_of_its_build(version_of, tmp_path):
    (tmp_path / "pyproject.toml").touch()
    assert version_of(tmp_path) == VERSION + UNKNOWN
    (tmp_path / "PKG-INFO").write_text("Metadata-Version: 2.4\nVersion: 0.3.0.dev7\n")
    assert version_of(tmp_path) == "0.3.0.dev7"


def test_versions_are_ordered_by_number_and_unknown_ones_are_not():
    versions = ["0.2.0", "0.3.0.dev9", "0.3.0.dev10", "0.3.0", "0.10.0.dev1"]
    for place, first in enumerate(versions):
        assert [is_older(first, second) for second in versions] == [
            place < other for other in range(len(versions))
        ]
    for unknown in ("", "next", "0.3.0.dev0"):
        assert not is_older(unknown, "0.3.0")
        assert not is_older("0.3.0.dev1", unknown)
