"""A few examples run as written, in an empty folder outside the clone, from a wheel; `make examples` runs all."""

import pytest
from uplift_cli.main import COMMANDS

from tests.examples import ELSEWHERE, ROOT, build_wheel, examples, run_lines, unpack

EXAMPLES = examples()
BEGIN = "uplift samples"
FEW = (
    BEGIN,
    "uplift relight wood.png -o wood.html",
    "uplift build --atlas macbeth --dim 32",
    "uplift query --cube macbeth-32.uplift --input colours.csv --format csv --mode refined > spectra.csv",
    "uplift bounds '#8a2a20'",
    "uplift advise wood.png --cube macbeth-32.uplift",
    "uplift texture wood.png -o wood.exr",
    "uplift mix --filter 2:'#ff8000' 1:0.5,0.5,0.5",
    "uplift export macbeth-32.uplift -o cube.h",
    "uplift lights query 30 22 9",
    "uplift info macbeth-32.uplift --format json | jq .status",
    "uplift slices macbeth-32.uplift -o macbeth-32.exr --plot macbeth-32.png",
    "uplift report macbeth-32.uplift --format json | jq .failures",
    "uplift check macbeth-32.uplift",
    "uplift build --atlas macbeth --library fabrics.csv -o fabrics.uplift",
    "uplift diff macbeth-32.uplift fabrics.uplift",
    "uplift atlas paints.csv -o paints.txt",
    "uplift wavelengths --count 8",
    "uplift palette metamers.toml",
    "uplift chart --recommend --time-ns 500",
    "uplift study moments",
    "uplift help modes",
)
"""Quick ones, in reading order: later lines use files of earlier ones."""
SLOW = {"plan": "tests/scene/plan/test_command.py", "compare": "tests/cli/test_compare.py"}
"""Commands whose examples take tens of seconds, and the tests that run them on small input."""


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    """The unpacked wheel."""
    folder = tmp_path_factory.mktemp("wheel")
    return unpack(build_wheel(folder), folder / "package")


@pytest.fixture(scope="module")
def outcomes(package, tmp_path_factory):
    """Outcomes of a few examples, run one after the other in one folder, by their lines."""
    found = run_lines(FEW, package, tmp_path_factory.mktemp("empty"))
    return {outcome["line"]: outcome for outcome in found}


@pytest.mark.parametrize("line", FEW)
def test_example_runs(outcomes, line):
    outcome = outcomes[line]
    assert outcome["code"] == 0, outcome["stderr"]
    assert "error: " not in outcome["stderr"]


def test_every_command_has_an_example_that_runs():
    assert BEGIN in EXAMPLES[:3]
    assert set(EXAMPLES) >= ELSEWHERE
    assert {line.split()[1] for line in FEW} >= set(COMMANDS) - SLOW.keys()
    assert set(FEW) <= set(EXAMPLES)
    assert all((ROOT / path).is_file() for path in SLOW.values())
