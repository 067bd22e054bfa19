"""Without matplotlib, commands that draw nothing work."""

import os
import subprocess
import sys

WITHOUT = """import sys
sys.modules.update(matplotlib=None)
from uplift_cli.main import main
for line in sys.argv[1:]:
    main(line.split(), standalone_mode=False)
"""


def test_colours_and_pages_without_figures_need_no_matplotlib(tmp_path, cubes):
    cube = cubes / "moments-8-macbeth.uplift"
    lines = (
        "query #f80 --light 6500K",
        f"relight -o page.html --cube {cube} --light A",
        "lab bounds #888 --html look.html",
    )
    subprocess.run(
        [sys.executable, "-c", WITHOUT, *lines],
        cwd=tmp_path,
        check=True,
        capture_output=True,
    )
    assert set(os.listdir(tmp_path)) == {"page.html", "look.html"}
