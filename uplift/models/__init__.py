"""Spectrum models: families of reflectance spectra in (0, 1), one per file, behind the
interface `Model`.
"""

from collections.abc import Mapping
from typing import Any

from uplift.models.minimum_norm import (
    ForwardMap,
    anchored_step,
    forward_map,
    minimum_norm_step,
    solve_damped,
)
from uplift.models.model import Model, evaluate, reflectance
from uplift.models.moments import Moments
from uplift.models.sigmoid import Sigmoid

__all__ = [
    "MODELS",
    "ForwardMap",
    "Model",
    "Moments",
    "Sigmoid",
    "anchored_step",
    "evaluate",
    "forward_map",
    "from_description",
    "minimum_norm_step",
    "reflectance",
    "solve_damped",
]


MODELS: dict[str, type[Model]] = {Moments.name: Moments, Sigmoid.name: Sigmoid}
"""Models by name."""


def from_description(description: Mapping[str, Any]) -> Model:
    """Create the model that `Model.describe` described.

    Parameters
    ----------
    description : mapping
        JSON values with the key ``"name"``.

    Returns
    -------
    Model

    Raises
    ------
    KeyError
        The name is unknown or a key is missing.
    TypeError
        A key is unknown.
    OptionError
        A number is out of range.
    UnknownNameError
        The warp is unknown.

    Examples
    --------
    >>> from_description(Sigmoid().describe())
    Sigmoid(start=380.0, end=780.0)
    """
    model = MODELS[description["name"]]
    parameters = {key: value for key, value in description.items() if key != "name"}
    return model.from_parameters(**parameters)
