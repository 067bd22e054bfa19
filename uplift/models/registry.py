"""The models by name."""

from collections.abc import Mapping
from typing import Any

from uplift.models.model import Model
from uplift.models.moments import Moments
from uplift.models.sigmoid import Sigmoid

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
