"""A scene so small that a plan for it takes seconds: few colours, few candidates,
coarse lattices.
"""

import shutil
import warnings

import numpy as np
import pytest

import uplift
from tests.conftest import MACBETH
from tests.extras.texture.conftest import planes, write_exr
from uplift.extras.scene import plan
from uplift.extras.scene.plan.candidates import SearchGrid

SMALL = SearchGrid(
    models={"none": (5, 9)},
    dims=(5, 8),
    axes=("srgb",),
    samples=(3, 5, 7),
    reference=12,
    predicting=60,
    confirming=90,
)
LIGHTS = ("D65", "FL11")


def painted():
    """(20, 20, 3) linear RGB: shades of four paints."""
    rng = np.random.default_rng(3)
    paints = np.array(
        [[0.5, 0.2, 0.1], [0.1, 0.3, 0.2], [0.2, 0.2, 0.5], [0.6, 0.6, 0.5]]
    )
    shades = rng.uniform(0.3, 1, (20, 20, 1)) * paints[rng.integers(0, 4, (20, 20))]
    return shades.astype(np.float32)


@pytest.fixture(scope="session")
def kitchen(tmp_path_factory):
    """The scene file, in a folder with all that it names."""
    folder = tmp_path_factory.mktemp("kitchen")
    write_exr(folder / "wood.exr", planes(painted()))
    shutil.copy(MACBETH, folder)
    path = folder / "kitchen.toml"
    path.write_text(
        (
            'textures = "wood.exr"\natlases = ["macbeth.txt"]\nlights = ["D65", '
            '"FL11"]\ntolerance = 3\n'
        ),
        encoding="utf-8",
    )
    return path


@pytest.fixture(scope="session")
def planned(kitchen):
    """The plan, and the steps that it took."""
    steps = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uplift.UpliftWarning)
        return plan.plan(plan.read_scene_file(kitchen), SMALL, steps.append), steps
