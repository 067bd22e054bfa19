"""Lights that a specification names: illuminants, or lamps in files of its folder."""

import os
from pathlib import Path
from typing import Any

from pydantic import ValidationInfo

from uplift.colorimetry import observer
from uplift.colorimetry.illuminants import Illuminant
from uplift.extras.emission.lamps import find_light, is_illuminant, lamp_file
from uplift.extras.files.spec import Key, check_inside, looking_up, spec_folder


def light_in_folder(name: Any, info: ValidationInfo, *at: Key) -> Illuminant:
    """Return an illuminant by its name, or read the lamp of a file; for validators of
    values at keys below the validated one.
    """
    folder = spec_folder(info)
    text = str(folder.path / check_inside(name, *at))
    file = lamp_file(text)
    with looking_up(*at):
        if is_illuminant(name) or not os.path.lexists(file):
            return observer.light(name).name
        folder.opened.append(Path(file))
        return find_light(text)
