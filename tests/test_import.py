"""``import uplift`` is light, changes nothing, and shows the whole interface."""

from __future__ import annotations

import inspect
import subprocess
import sys

import pytest

import uplift

HEAVY = "{'numpy', 'jax', 'colour', 'scipy', 'safetensors', 'matplotlib', 'click', 'rich'}"


def in_a_fresh_process(code):
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return done.stdout.strip()


def test_importing_costs_nothing_not_even_numpy():
    assert in_a_fresh_process(f"import sys, uplift; print({HEAVY} & set(sys.modules))") == "set()"


def test_the_check_sees_what_is_loaded():
    code = f"import sys, uplift; uplift.Atlas; print({HEAVY} & set(sys.modules))"
    assert in_a_fresh_process(code) == "{'numpy'}"


def test_loading_a_cube_costs_numpy_and_the_file_s_library():
    code = f"import sys, uplift; uplift.load(); print(sorted({HEAVY} & set(sys.modules)))"
    assert in_a_fresh_process(code) == "['numpy', 'safetensors']"


@pytest.mark.parametrize(
    "use",
    [
        "pass",
        "uplift.load().reflectance([0.5, 0.5, 0.5])",
        "uplift.build(dim=2)",
        "from uplift.lookup import bulk; bulk.spectra(uplift.load(), [500])([0.5, 0.5, 0.5])",
    ],
)
def test_no_setting_of_jax_is_changed(use):
    code = (
        "import jax, jax.numpy as jnp\n"
        "before = dict(jax.config.values)\n"
        f"import uplift\n{use}\n"
        "print({name for name, value in jax.config.values.items() if before.get(name) != value})\n"
        "print(jnp.zeros(1).dtype)"
    )
    assert in_a_fresh_process(code) == "set()\nfloat32"


def test_no_setting_of_numpy_or_of_warnings_is_changed():
    code = (
        "import numpy, warnings\n"
        "before = numpy.geterr(), numpy.get_printoptions(), list(warnings.filters), warnings.showwarning\n"
        "import uplift\nuplift.build(dim=2)\n"
        "after = numpy.geterr(), numpy.get_printoptions(), list(warnings.filters), warnings.showwarning\n"
        "print([one for one, other in zip(before, after) if one != other])"
    )
    assert in_a_fresh_process(code) == "[]"


def test_dir_lists_the_interface():
    assert set(dir(uplift)) == {*uplift.__all__, "__version__"}
    assert uplift.__all__ == sorted(uplift.__all__)


@pytest.mark.parametrize("name", uplift.__all__)
def test_every_name_of_the_interface_is_documented_at_its_home(name):
    found = getattr(uplift, name)
    home = found.__name__ if inspect.ismodule(found) else f"{found.__module__}.{found.__name__}"
    assert home.startswith("uplift.")
    assert home.endswith(f".{name}")
    assert found.__doc__


def test_star_import_brings_the_interface():
    names = in_a_fresh_process("from uplift import *; print(*sorted(n for n in dir() if n[0] != '_'))")
    assert names.split() == uplift.__all__


def test_unknown_names_raise_attribute_error():
    with pytest.raises(AttributeError, match="module 'uplift' has no attribute 'paint'"):
        _ = uplift.paint
    assert not hasattr(uplift, "np")
    with pytest.raises(ImportError):
        exec("from uplift import paint")
