"""Build the stored cubes of ``cubes/``, which ``uplift check`` compares, the kit of
``docs/conformance/``, and the cubes and lights of the package.
"""

import shutil
import warnings
from itertools import product
from pathlib import Path

import uplift
from uplift.extras.emission.lookup import EMISSION
from uplift.extras.report.conformance_kit import build_cube, write_kit
from uplift.pipeline.options import ModelName

ROOT = Path(__file__).parents[1]
LOOKUP = ROOT / "uplift" / "lookup"


def main() -> None:
    """Build all cubes, the kit and the emission table."""
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    models: tuple[ModelName, ...] = ("moments", "sigmoid")
    for model, dim, atlas in product(models, (8, 16), (None, "macbeth")):
        source = ROOT / "atlases" / f"{atlas}.txt" if atlas else None
        name = "-".join(filter(None, (model, str(dim), atlas)))
        path = ROOT / "cubes" / f"{name}.uplift"
        uplift.build(source, dim=dim, model=model, debug=True).save(path, force=True)
    # The cube that is installed with the package: sRGB, D65, without an atlas
    shutil.copyfile(ROOT / "cubes" / "moments-16.uplift", LOOKUP / "default.uplift")
    uplift.build(dim=16, space="ACEScg").save(LOOKUP / "acescg.uplift", force=True)
    write_kit(build_cube(), ROOT / "docs" / "conformance", force=True)
    uplift.build_emission().save(EMISSION, force=True)


if __name__ == "__main__":
    main()
