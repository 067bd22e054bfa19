"""The version: of a commit in a clone, of its build in a distribution, and unknown
elsewhere.
"""

import shutil

import pytest

from tests.helpers import output_of
from uplift.common import version
from uplift.common.version import UNKNOWN, is_older

COMING = "0.4.0.dev"


@pytest.fixture
def version_of(monkeypatch):
    """The version of the source in a folder, on the way to a release, or of one."""

    def version_of(folder, stated=COMING):
        monkeypatch.setattr(version, "ROOT", folder)
        monkeypatch.setattr(version, "VERSION", stated)
        return version.version.__wrapped__()

    return version_of


@pytest.mark.skipif(shutil.which("git") is None, reason="no git")
def test_every_commit_has_a_version_that_a_shallow_clone_does_not_know(
    version_of, tmp_path
):
    def git(*arguments):
        identity = [
            "-c",
            "user.name=a",
            "-c",
            "user.email=a@b.c",
            "-c",
            "commit.gpgsign=false",
        ]
        output_of("git", *identity, *arguments, cwd=tmp_path)

    git("init")
    for count in (1, 2):
        git("commit", "--allow-empty", "-m", "change")
        assert version_of(tmp_path) == f"{COMING}{count}"
    assert version_of(tmp_path, "0.4.0rc1") == "0.4.0rc1"
    git("clone", "--depth", "1", tmp_path.as_uri(), "shallow")
    assert version_of(tmp_path / "shallow") == COMING + UNKNOWN


def test_a_source_distribution_has_the_version_of_its_build(version_of, tmp_path):
    (tmp_path / "pyproject.toml").touch()
    assert version_of(tmp_path) == COMING + UNKNOWN
    (tmp_path / "PKG-INFO").write_text("Metadata-Version: 2.4\nVersion: 0.3.0.dev7\n")
    assert version_of(tmp_path) == "0.3.0.dev7"


def test_versions_are_ordered_by_number_and_unknown_ones_are_not():
    versions = [
        "0.2.0",
        "0.3.0.dev9",
        "0.3.0.dev10",
        "0.3.0rc1.dev11",
        "0.3.0rc1",
        "0.3.0rc2.dev12",
        "0.3.0rc10",
        "0.3.0",
        "0.10.0.dev1",
    ]
    for place, first in enumerate(versions):
        for other, second in enumerate(versions):
            assert is_older(first, second) == (place < other)
    for unknown in ("", "next", "0.3.0.dev0"):
        assert not is_older(unknown, "0.3.0.dev1")
        assert not is_older("0.3.0.dev1", unknown)
