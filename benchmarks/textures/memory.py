"""Peak memory of `uplift texture` by the size of the image → docs/data/textures-memory.json.

Memory does not depend on the height: a few bands of rows suffice for each width, and one image is whole.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.processes import UPLIFT
from benchmarks.record import write
from benchmarks.timing import process

SIZES = ((2048, 512), (4096, 512), (8192, 512), (8192, 8192), (16384, 512))
"""Columns and rows."""


def main() -> None:
    """Measure and write."""
    peaks = [_measure(*size) for size in SIZES]
    write("textures-memory", "python -m benchmarks.textures.memory", peaks=peaks)


def _measure(width: int, rows: int) -> dict[str, Any]:
    from PIL import Image

    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder) / "in.png", Path(folder) / "out.exr"
        codes = np.random.default_rng(0).integers(0, 256, (rows, width, 3), dtype=np.uint8)
        Image.fromarray(codes).save(source, compress_level=1)
        _, megabytes = process([UPLIFT, "texture", str(source), "-o", str(target)], 1)
        return {"width": width, "rows": rows, "peak_mb": megabytes}


if __name__ == "__main__":
    main()
