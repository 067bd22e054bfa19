"""Contact sheet: its file."""

import numpy as np
import OpenEXR

from tests.cube.hand_made import hand_made
from uplift.extras.pages.sheet import write_sheet


def test_an_exr_sheet_has_one_part(tmp_path):
    write_sheet(hand_made(), tmp_path / "sheet.exr")
    (part,) = OpenEXR.File(str(tmp_path / "sheet.exr")).parts
    assert part.header["uplift.dim"] == 4
    pixels = part.channels["RGB"].pixels
    assert pixels.dtype == np.float32
    assert pixels.max() == 1
