"""Without the extra ``plots``, figures name it and all else works; each command in its own process."""

import subprocess
import sys

import pytest

WITHOUT = (
    "import sys; sys.modules.update(matplotlib=None, PIL=None)\nfrom uplift_cli.main import main; main(sys.argv[1:])"
)


def run(folder, *words):
    command = [sys.executable, "-c", WITHOUT, *map(str, words)]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


@pytest.mark.parametrize(
    "words", [("query", "#f80", "--plot", "a.png"), ("relight",), ("report", "{cube}", "-o", "report.html")]
)
def test_figures_name_the_extra(tmp_path, cubes, words):
    done = run(tmp_path, *(word.format(cube=cubes / "moments-8-macbeth.uplift") for word in words))
    assert done.returncode == 2
    assert "'spectral-uplift[plots]'" in done.stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "words",
    [("query", "#f80", "--light", "6500K"), ("relight", "-o", "page.html", "--cube", "{cube}", "--light", "A")],
)
def test_other_commands_do_not_need_it(tmp_path, cubes, words):
    done = run(tmp_path, *(word.format(cube=cubes / "moments-8-macbeth.uplift") for word in words))
    assert done.returncode == 0, done.stderr
