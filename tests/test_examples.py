"""Every example runs as written, in an empty folder outside the clone, from an installed wheel."""

from __future__ import annotations

import shutil

import pytest

from tests.conftest import ROOT
from tests.examples.collect import Example, examples, page_examples
from tests.examples.installed import build_wheel, run_lines, unpack
from tests.examples.reduced import ELSEWHERE, REDUCED, SMALL_SCENE

EXAMPLES = examples()
BEGIN = "uplift samples"


def reduced(line):
    """The line that the tests run in place of an example; None for one that they only parse."""
    return None if line in ELSEWHERE else REDUCED.get(line, (line, ""))[0]


RUN = {each.line: reduced(each.line) for each in EXAMPLES if reduced(each.line) is not None}


@pytest.fixture(scope="session")
def package(tmp_path_factory):
    """The unpacked wheel."""
    if shutil.which("git") is None or not (ROOT / ".git").exists():
        pytest.skip("needs the git checkout to know its files")
    folder = tmp_path_factory.mktemp("wheel")
    return unpack(build_wheel(folder), folder / "package")


@pytest.fixture(scope="session")
def outcomes(package, tmp_path_factory):
    """Outcomes of all examples, run one after the other in one folder, by their lines."""
    folder = tmp_path_factory.mktemp("empty")
    lines = [line for line in RUN.values() if line != BEGIN]
    begin = run_lines([BEGIN], package, folder)
    (folder / "kitchen.toml").write_text(SMALL_SCENE)
    found = [*begin, *run_lines(lines, package, folder)]
    return {outcome["line"]: outcome for outcome in found}


@pytest.mark.parametrize("line", [line for line in RUN if line.startswith("uplift ")])
def test_example_runs(outcomes, line):
    outcome = outcomes[RUN[line]]
    assert outcome["code"] == 0, outcome["stderr"]
    assert "error: " not in outcome["stderr"]


def test_the_samples_are_copied_first():
    assert EXAMPLES[0].source == "README.md"
    assert BEGIN in [example.line for example in EXAMPLES[:3]]


def test_reduced_examples_are_written_somewhere():
    lines = {example.line for example in EXAMPLES}
    assert REDUCED.keys() <= lines
    assert ELSEWHERE.keys() <= lines
    assert len(REDUCED) < len(lines) / 3


def test_examples_come_from_all_places():
    sources = {example.source for example in EXAMPLES}
    assert {"README.md", "docs/commands.md", "uplift query --help", "uplift study moments --help"} <= sources
    assert len(EXAMPLES) > 100


def test_blocks_of_pages_are_read():
    text = "```console\n$ uplift a 'b c' \\\n  d    # remark\nout\n```\n```python\nuplift x\n```\n```\nuplift e\n```\n"
    assert list(page_examples("p", text)) == [Example("p", "uplift a 'b c' d"), Example("p", "uplift e")]


def test_failures_are_noticed(package, tmp_path):
    lines = [
        "mkdir -p data",
        "uplift query 1 1 1 > data/white.txt",
        "uplift query 2 2 2",
        "uplift info none.uplift",
    ]
    good, bad, missing = run_lines(lines, package, tmp_path)
    assert (good["code"], bad["code"], missing["code"]) == (0, 2, 2)
    assert (tmp_path / "data" / "white.txt").read_text() == good["stdout"]
    assert "error: none.uplift" in missing["stderr"]


def test_missing_keys_of_json_are_noticed(package, tmp_path):
    found, lost = run_lines(
        ["uplift atlas --format json macbeth | jq .entries", "uplift atlas --format json macbeth | jq .no"],
        package, tmp_path,
    )  # fmt: skip
    assert (found["code"], lost["code"]) == (0, 1)
