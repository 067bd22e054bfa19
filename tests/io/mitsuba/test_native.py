"""Compilation of the texture in C++: errors, and plugins that are not used."""

from __future__ import annotations

import shutil
import stat
import sys

import pytest

from tests.helpers import raises
from uplift.common.errors import OptionError
from uplift.io.mitsuba import compile_plugin
from uplift.io.mitsuba.native import compile as native


@pytest.fixture(autouse=True)
def cache(mi, monkeypatch, tmp_path):
    """An empty cache folder."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.delenv("CXX", raising=False)


def _compiler(path, body):
    """Write a program that stands in for a compiler, and return its name."""
    path.write_text(f"#!/bin/sh\n{body}\n")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return str(path)


def test_a_missing_compiler_raises(monkeypatch):
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with raises(OptionError, "compiler-not-found"):
        compile_plugin()


def test_missing_headers_raise(monkeypatch):
    monkeypatch.setenv("CXX", "c++")
    monkeypatch.setitem(sys.modules, "nanobind", None)
    with raises(OptionError, "headers-not-installed"):
        compile_plugin()


def test_a_failing_compiler_raises_its_first_error(monkeypatch, tmp_path):
    pytest.importorskip("nanobind")
    monkeypatch.setenv("CXX", _compiler(tmp_path / "failing", "echo 'note'; echo 'error: no' >&2; exit 1"))
    with raises(OptionError, "plugin-not-compiled") as caught:
        compile_plugin()
    assert "error: no" in str(caught.value)
    assert native.find_plugin() is None


def test_a_plugin_that_cannot_be_loaded_is_removed(monkeypatch, tmp_path):
    """The library that the compiler writes is empty."""
    pytest.importorskip("nanobind")
    monkeypatch.setenv("CXX", _compiler(tmp_path / "empty", 'echo > "$3"'))
    with raises(OptionError, "plugin-incompatible"):
        compile_plugin()
    assert native.find_plugin() is None


def test_a_folder_that_others_can_write_to_is_not_used(compiled, monkeypatch, tmp_path):
    folder = tmp_path / "shared"
    shutil.copytree(compiled, folder)
    monkeypatch.setattr(native, "_folder", lambda: folder)
    assert native.find_plugin() == folder
    folder.chmod(0o777)
    assert native.find_plugin() is None
    with raises(OptionError, "shared-plugin-folder"):
        compile_plugin()
