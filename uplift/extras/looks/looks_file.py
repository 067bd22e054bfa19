"""A file of looks, whose values `uplift.extras.looks.look.Look` checks."""

from typing import Annotated, Any

from pydantic import ConfigDict, Field

from uplift.extras.files.spec import SpecModel

MAX_LOOKS = 10_000


class LookTable(SpecModel):
    """A look: further keys are the names of lights."""

    model_config = ConfigDict(extra="allow")

    rgb: Any
    weight: Any = 1.0
    name: Any = ""


class LooksFile(SpecModel):
    look: Annotated[list[LookTable], Field(min_length=1, max_length=MAX_LOOKS)]
