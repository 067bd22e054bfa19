"""The version: of a commit in a clone, of its build in a distribution, and unknown elsewhere."""

import shutil
import subprocess
import sys

import pytest

from uplift.common import version as module
from uplift.common.version import UNKNOWN, VERSION, is_older, version


@pytest.fixture
def root(tmp_path, monkeypatch):
    """A folder in place of the clone."""
    monkeypatch.setattr(module, "ROOT", tmp_path)
    version.cache_clear()
    yield tmp_path
    version.cache_clear()


def git(folder, *arguments):
    identity = ("-c", "user.name=a", "-c", "user.email=a@b.c", "-c", "commit.gpgsign=false")
    subprocess.run(["git", *identity, "-C", folder, *arguments], check=True, capture_output=True)


@pytest.mark.skipif(shutil.which("git") is None, reason="no git")
def test_every_commit_has_a_version_that_a_shallow_clone_does_not_know(root, monkeypatch):
    whole, shallow = root / "whole", root / "shallow"
    git(root, "init", whole)
    for count in (1, 2):
        git(whole, "commit", "--allow-empty", "-m", "change")
        monkeypatch.setattr(module, "ROOT", whole)
        version.cache_clear()
        assert version() == f"{VERSION}{count}"
    git(root, "clone", "--depth", "1", whole.as_uri(), shallow)
    monkeypatch.setattr(module, "ROOT", shallow)
    version.cache_clear()
    assert version() == VERSION + UNKNOWN


def test_a_source_distribution_has_the_version_of_its_build(root):
    (root / "pyproject.toml").touch()
    assert version() == VERSION + UNKNOWN
    (root / "PKG-INFO").write_text("Metadata-Version: 2.4\nName: spectral-uplift\nVersion: 0.3.0.dev7\n")
    version.cache_clear()
    assert version() == "0.3.0.dev7"


def test_import_asks_no_git():
    code = "import sys, uplift.common.version; assert not {'subprocess', 'importlib.metadata'} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_versions_are_ordered_by_number_and_unknown_ones_are_not():
    versions = ["0.2.0", "0.3.0.dev9", "0.3.0.dev10", "0.3.0", "0.10.0.dev1"]
    for place, first in enumerate(versions):
        assert [is_older(first, second) for second in versions] == [place < other for other in range(len(versions))]
    for unknown in ("", "next", "0.3.0.dev0"):
        assert not is_older(unknown, "0.3.0")
        assert not is_older("0.3.0.dev1", unknown)
