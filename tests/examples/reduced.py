"""Examples that take long, and the lines that the tests run in their place. ``make examples`` runs them as written."""

from __future__ import annotations

SMALL_SCENE = """textures = "wood.png"
atlases = ["paints.csv"]
lights = ["D65"]
tolerance = 4
"""
"""kitchen.toml of the tests: a plan of one small texture under one light takes a third of the time."""

MINUTES = "takes minutes"
TENS_OF_SECONDS = "takes tens of seconds"
RUNS_ELSEWHERE = "takes minutes in every variant; tests/cli/test_study_stability.py runs it on a small grid"

REDUCED: dict[str, tuple[str | None, str]] = {
    "uplift build --atlas macbeth --observer 'Nikon 5100 (NPL)' --space camera --dim 16": (
        "uplift build --atlas macbeth --observer 'Nikon 5100 (NPL)' --space camera --dim 6 "
        "-o macbeth-16-camera.uplift",
        TENS_OF_SECONDS,
    ),
    "uplift build --atlas paints.csv --range 360:830 --step 1 -o range.uplift": (
        "uplift build --atlas paints.csv --range 360:830 --step 10 --dim 6 -o range.uplift",
        TENS_OF_SECONDS,
    ),
    "uplift build --observer 'Sigma SDMerill (NPL)' --space camera --illuminant A --dim 16 -o tungsten.uplift": (
        "uplift build --observer 'Sigma SDMerill (NPL)' --space camera --illuminant A --dim 6 -o tungsten.uplift",
        TENS_OF_SECONDS,
    ),
    "uplift export macbeth-32.uplift srgb.coeff": (
        "uplift export macbeth-32.uplift srgb.coeff --res 8",
        TENS_OF_SECONDS,
    ),
    "uplift export paints.uplift data/srgb.coeff": (
        "uplift export paints.uplift data/srgb.coeff --res 8",
        TENS_OF_SECONDS,
    ),
    "uplift chart --atlas paints.csv -o paints": (
        "uplift chart --quick --atlas paints.csv --methods mallett2019 -o paints",
        MINUTES,
    ),
    "uplift chart --quick": ("uplift chart --quick --methods mallett2019", TENS_OF_SECONDS),
    "uplift chart --methods 'moments9-32-*' --methods mallett2019 -o few": (
        None,
        "takes minutes; reduced, it is the chart above in another folder",
    ),
    "uplift chart --recommend --from paints/chart.csv --delta-e 1 --light A": (
        None,
        "needs the cubes of the full chart",
    ),
    "uplift chart --recommend --from paints/chart.csv --delta-e 1": (
        None,
        "needs the cubes of the full chart",
    ),
    "uplift compare --target 1.0": (None, TENS_OF_SECONDS),
    "uplift compare --atlas paints.csv --light LED-B3 --light HP1 --target 0.5": (None, TENS_OF_SECONDS),
    "uplift compare --atlas paints.csv --light LED-B3 --light HP1 --filters --output filters": (
        None,
        TENS_OF_SECONDS,
    ),
    "uplift compare --filters --output filters --force": (None, TENS_OF_SECONDS),
    "uplift compare --quick": (None, "tests/cli/test_compare.py runs it in every variant"),
    "uplift plan kitchen.toml --format json --force": (None, "is the plan above with other output"),
    "uplift plan kitchen.toml -o other.plan.json": (None, "is the plan above with other output"),
    "uplift study held-out --atlas paints.csv": (
        "uplift study held-out --atlas paints.csv --splits 1",
        TENS_OF_SECONDS,
    ),
    "uplift study held-out --atlas rawtoaces --coefficients 17 --splits 10": (None, MINUTES),
    "uplift study held-out --format json": (None, MINUTES),
    "uplift study sensitivity": (None, "tests/cli/test_study_stability.py runs it"),
    "uplift study sensitivity macbeth-32.uplift": (None, TENS_OF_SECONDS),
    "uplift study sensitivity macbeth-32.uplift --output out --force": (None, TENS_OF_SECONDS),
    "uplift study sensitivity macbeth-32.uplift --entries 4 --output sensitivity": (
        None,
        "takes tens of seconds; tests/cli/test_study_stability.py runs it on a small cube",
    ),
    "uplift study sensitivity --entries 4 --format json": (None, TENS_OF_SECONDS),
    "uplift study stability --quick": (None, RUNS_ELSEWHERE),
    "uplift study stability --quick --output stability": (None, RUNS_ELSEWHERE),
    "uplift study stability --output out --force": (None, RUNS_ELSEWHERE),
    "uplift study stability --thresholds 1e-4,1e-6 --dims 9 --format csv": (None, RUNS_ELSEWHERE),
}
"""Line to run, or None for lines that are only parsed (tests/test_docs.py), and the reason."""

ELSEWHERE: dict[str, str] = {
    "uplift texture 'shot.*.exr' sequence --cube macbeth-32.uplift --scheduler tcp://10.0.0.5:8786": (
        "needs a Dask cluster at that address"
    ),
    "uplift texture 'shot.*.exr' uplifted --scheduler tcp://10.0.0.5:8786": "needs a Dask cluster at that address",
    "uplift texture shot.*.exr uplifted --scheduler tcp://10.0.0.5:8786": "needs a Dask cluster at that address",
}
"""Lines that run on no single machine."""
