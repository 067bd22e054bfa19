"""Without the extra ``plots``, figures name it and all else works."""

import subprocess
import sys

WITHOUT = """import os, sys
sys.modules.update(matplotlib=None, PIL=None)
from uplift_cli.main import main
for line in sys.argv[1:]:
    try:
        main(line.split())
    except SystemExit as done:
        print(done.code, *os.listdir(), file=sys.stderr)
"""


def test_figures_name_the_extra_and_other_commands_do_not_need_it(tmp_path, cubes):
    cube = cubes / "moments-8-macbeth.uplift"
    figures = ("query #f80 --plot a.png", "relight", f"report {cube} -o report.html")
    others = ("query #f80 --light 6500K", f"relight -o page.html --cube {cube} --light A")
    command = [sys.executable, "-c", WITHOUT, *figures, *others]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
    errors = done.stderr.splitlines()
    assert errors[1:6:2] == ["2"] * 3  # and no file
    assert all("'spectral-uplift[plots]'" in line for line in errors[:6:2])
    assert errors[-1] == "0 page.html"
