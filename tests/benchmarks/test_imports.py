"""Benchmarks are not run by the tests, but each of their modules can be imported."""

from __future__ import annotations

import importlib
import pkgutil

import pytest

import benchmarks

NAMES = [module.name for module in pkgutil.walk_packages(benchmarks.__path__, "benchmarks.")]


@pytest.mark.parametrize("name", NAMES)
def test_module_can_be_imported(name):
    importlib.import_module(name)


def test_all_folders_are_walked():
    assert {"benchmarks.bench", "benchmarks.fidelity.cubes", "benchmarks.render.__main__"} <= set(NAMES)
