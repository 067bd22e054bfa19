"""Write ``uplift/extras/export/uplift.h`` of its parts: ``python -m
tools.ship_header``.

tests/extras/export/test_runtime.py fails when the file is not that of the source.
"""

from pathlib import Path

from uplift.common.files import write_text
from uplift.extras.export.runtime import HEADER, compose_header

PATH = Path(__file__).parents[1] / "uplift" / "extras" / "export" / HEADER

if __name__ == "__main__":
    write_text(compose_header(), PATH, force=True)
