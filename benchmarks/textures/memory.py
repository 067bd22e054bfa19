"""Peak memory of `uplift texture` by the width of the image → docs/data/textures-memory.json.

Memory does not depend on the height, so a few bands of rows suffice.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.processes import UPLIFT
from benchmarks.record import write
from benchmarks.timing import process

WIDTHS = (2048, 4096, 8192, 16384)
ROWS = 512


def main() -> None:
    """Measure and write."""
    peaks = [_measure(width) for width in WIDTHS]
    write("textures-memory", "python -m benchmarks.textures.memory", rows=ROWS, peaks=peaks)


def _measure(width: int) -> dict[str, Any]:
    from PIL import Image

    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder) / "in.png", Path(folder) / "out.exr"
        codes = np.random.default_rng(0).integers(0, 256, (ROWS, width, 3), dtype=np.uint8)
        Image.fromarray(codes).save(source, compress_level=1)
        _, megabytes = process([UPLIFT, "texture", str(source), str(target)], 1)
        return {"width": width, "peak_mb": megabytes}


if __name__ == "__main__":
    main()
