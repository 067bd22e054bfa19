"""Build the stored cubes of ``cubes/``, which ``uplift check`` compares, and the cubes and lights of the package."""

from __future__ import annotations

import shutil
import warnings
from itertools import product
from pathlib import Path

import uplift
from uplift.lights.lookup import EMISSION

ROOT = Path(__file__).parents[1]
DEFAULT = "moments-16"
"""The stored cube that is installed with the package: sRGB, D65, without an atlas."""
WIDE = {"acescg": "ACEScg"}
"""Other cubes that are installed with the package, by file name and space."""
LOOKUP = ROOT / "uplift" / "lookup"


def main() -> None:
    """Build all cubes."""
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    for model, dim, atlas in product(("moments", "sigmoid"), (8, 16), (None, "macbeth")):
        source = ROOT / "atlases" / f"{atlas}.txt" if atlas else None
        path = ROOT / "cubes" / ("-".join(filter(None, (model, str(dim), atlas))) + ".uplift")
        uplift.build(source, dim=dim, model=model, debug=True).save(path, force=True)
        print(path.relative_to(ROOT))
    shutil.copyfile(ROOT / "cubes" / f"{DEFAULT}.uplift", LOOKUP / "default.uplift")
    store_wide()
    store_emission()


def store_wide() -> None:
    """Build the cubes of other spaces that are installed with the package."""
    for name, space in WIDE.items():
        uplift.build(dim=16, space=space).save(LOOKUP / f"{name}.uplift", force=True)
        print(f"uplift/lookup/{name}.uplift")


def store_emission() -> None:
    """Build the emission table that is installed with the package."""
    uplift.build_emission().save(EMISSION, force=True)
    print(EMISSION.relative_to(ROOT))


if __name__ == "__main__":
    main()
