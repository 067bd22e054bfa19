"""``import uplift`` is light, changes no global setting, and exposes the public
interface.
"""

import re

import pytest

import uplift
from tests.helpers import run_python

CORE = {"common", "colorimetry", "models", "lattice", "cube", "lookup"}
HEAVY_OF_FITS = {"colour", "scipy", "jax", "equinox", "optimistix"}


def loaded_subpackages(code):
    """Run code in a new process and return the subpackages of uplift that it loads, and
    its loaded modules.
    """
    modules = run_python(f"{code}\nimport sys; print(*sys.modules)").split()
    ours = [name for name in modules if name.startswith("uplift.")]
    rooms = {re.sub(r"uplift\.((?:extras\.)?\w+).*", r"\1", name) for name in ours}
    return rooms - {"extras"}, set(modules)


def command(*words):
    """Code that runs a command."""
    return (
        f"from uplift_cli.main import main\ntry: main({list(words)})\n"
        "except SystemExit: pass"
    )


QUERY = command("query", "#123456", "--format", "json")
RECOMMENDATION = command("chart", "--recommend", "--tolerance", "1")


def test_queries_load_only_the_core():
    assert not loaded_subpackages("import uplift")[1] & {
        "numpy",
        "click",
        *HEAVY_OF_FITS,
    }
    assert not loaded_subpackages(QUERY)[1] & {
        "matplotlib",
        "rich",
        "logging",
        "subprocess",
        "numpy.ma",
        *HEAVY_OF_FITS,
    }
    assert not loaded_subpackages(RECOMMENDATION)[1] & {"matplotlib", *HEAVY_OF_FITS}
    for code, more in (
        ("uplift.load().reflectance([0.5, 0.5, 0.5], wavelengths=[400, 500])", set()),
        ("uplift.load_emission().spectrum([0.5, 0.5, 0.5])", {"extras.emission"}),
    ):
        subpackages, modules = loaded_subpackages(f"import uplift; {code}")
        assert subpackages <= CORE | more
        assert not modules & {
            "uplift.colorimetry.observer",
            "uplift.lookup.bulk",
            *HEAVY_OF_FITS,
        }


def test_builds_load_only_the_core_and_change_no_setting():
    """Of JAX, numpy and warnings."""
    code = (
        # these two add filters of warnings themselves
        "import numpy, warnings, scipy.special, scipy.sparse\n"
        "def settings():\n"
        "    return numpy.geterr(), numpy.get_printoptions(), list(warnings.filters), "
        "warnings.showwarning\n"
        "before = settings()\n"
        "import jax, jax.numpy as jnp\n"
        "of_jax = dict(jax.config.values)\n"
        "import uplift.bulk\n"
        "uplift.load().reflectance([0.5, 0.5, 0.5]); uplift.build(dim=2)\n"
        "uplift.bulk.spectra(uplift.load(), [500])([0.5, 0.5, 0.5])\n"
        "assert settings() == before\n"
        "for name, value in jax.config.values.items():\n"
        "    assert of_jax.get(name) == value, name\n"
        "assert jnp.zeros(1).dtype == 'float32'\n"
    )
    assert loaded_subpackages(code)[0] == CORE | {
        "atlas",
        "bulk",
        "fit",
        "pipeline",
    }


def test_only_the_interface_is_listed_and_can_be_imported():
    assert dir(uplift) == sorted(vars(uplift)["__all__"])
    with pytest.raises(ImportError):
        exec("from uplift import paint")
