"""Importing is light and changes nothing."""

from __future__ import annotations

import subprocess
import sys

import pytest

import uplift


def python(code):
    return subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    ).stdout.strip()


def test_importing_uplift_loads_nothing_heavy():
    code = "import sys; before = set(sys.modules); import uplift; print(*sorted(set(sys.modules) - before))"
    loaded = {name.split(".")[0] for name in python(code).split()}
    assert not loaded & {
        "numpy",
        "jax",
        "scipy",
        "colour",
        "optimistix",
        "click",
        "rich",
        "matplotlib",
        "safetensors",
    }


def test_the_whole_library_changes_no_setting_of_jax():
    code = (
        "import jax, warnings; before = dict(jax.config.values)\n"
        "import uplift.pipeline, uplift.rebuild, uplift.report.regression\n"
        "uplift.build(dim=2, model='sigmoid'); print(before == dict(jax.config.values), jax.numpy.zeros(1).dtype)"
    )
    assert python(code) == "True float32"


def test_every_public_name_is_there():
    assert set(uplift.__all__) <= set(dir(uplift))
    for name in uplift.__all__:
        assert getattr(uplift, name) is not None


def test_other_names_are_not():
    with pytest.raises(AttributeError, match="no attribute 'bulid'"):
        _ = uplift.bulid
