"""The cache folder of compiled code: who may write to it, and what becomes of damaged entries."""

from __future__ import annotations

import os
import stat
import zlib
from pathlib import Path

import pytest
from uplift_cli.jit_cache import SharedFolderError, prepare
from uplift_cli.startup import enable_jit_cache

from tests.helpers import warns

pytestmark = pytest.mark.skipif(os.name == "nt", reason="permissions of POSIX")
GOOD = zlib.compress(bytes(range(256)) * 99)


@pytest.fixture
def folder(tmp_path):
    path = tmp_path / "cache"
    assert prepare(path)
    return path


def test_a_new_folder_is_private(tmp_path):
    previous = os.umask(0)
    try:
        assert prepare(tmp_path / "a")
    finally:
        os.umask(previous)
    assert stat.S_IMODE((tmp_path / "a").stat().st_mode) == 0o700


@pytest.mark.parametrize("mode", [0o777, 0o770, 0o720, 0o702])
def test_a_folder_that_others_can_write_to_is_refused(folder, mode):
    folder.chmod(mode)
    with pytest.raises(SharedFolderError):
        prepare(folder)


def test_a_folder_that_others_can_replace_is_refused(tmp_path):
    parent = tmp_path / "open"
    parent.mkdir()
    parent.chmod(0o777)
    with pytest.raises(SharedFolderError):
        prepare(parent / "cache")
    parent.chmod(0o1777)
    assert prepare(parent / "cache")


def test_a_link_is_judged_by_its_target(folder, tmp_path):
    (tmp_path / "link").symlink_to(folder)
    folder.chmod(0o777)
    with pytest.raises(SharedFolderError):
        prepare(tmp_path / "link")


def test_incomplete_entries_are_removed_and_others_kept(folder):
    contents = {
        "good": GOOD,
        "cut": GOOD[:-1],
        "empty": b"",
        "flipped": GOOD[:-1] + b"x",
        "zstd": b"\x28\xb5",
    }
    for name, content in contents.items():
        (folder / f"jit_{name}-0-cache").write_bytes(content)
    assert prepare(folder)
    assert sorted(path.name for path in folder.glob("*-cache")) == ["jit_good-0-cache", "jit_zstd-0-cache"]


def test_entries_that_others_can_write_to_and_links_are_removed(folder, tmp_path):
    (tmp_path / "elsewhere").write_bytes(GOOD)
    (folder / "jit_link-0-cache").symlink_to(tmp_path / "elsewhere")
    (folder / "jit_open-0-cache").write_bytes(GOOD)
    (folder / "jit_open-0-cache").chmod(0o666)
    assert prepare(folder)
    assert not list(folder.glob("*-cache"))
    assert (tmp_path / "elsewhere").exists()


def test_verified_entries_are_not_read_again(folder, monkeypatch):
    (folder / "jit_good-0-cache").write_bytes(GOOD)
    os.utime(folder / "jit_good-0-cache", (1, 1))
    monkeypatch.setattr(zlib, "decompress", lambda content: pytest.fail("read"))
    assert prepare(folder)


def test_without_a_home_folder_nothing_is_created(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert not prepare(Path("~/.cache/uplift"))
    assert not list(tmp_path.iterdir())


def test_the_command_warns_of_a_shared_folder_and_does_not_use_it(folder, monkeypatch):
    monkeypatch.delenv("JAX_COMPILATION_CACHE_DIR", raising=False)
    monkeypatch.setattr("platformdirs.user_cache_dir", lambda name: str(folder))
    folder.chmod(0o777)
    with warns("shared-cache"):
        enable_jit_cache()
    assert "JAX_COMPILATION_CACHE_DIR" not in os.environ
    folder.chmod(0o700)
    monkeypatch.setenv("JAX_COMPILATION_CACHE_DIR", "")  # so that it is restored
    monkeypatch.delenv("JAX_COMPILATION_CACHE_DIR")
    with warns():
        enable_jit_cache()
    assert os.environ["JAX_COMPILATION_CACHE_DIR"] == str(folder)
