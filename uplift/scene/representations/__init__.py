"""Spectral representations for renderers: one method per module, all with the protocol `Representation`.

References
----------
Kment 2011, "Spectral data representation techniques for realistic image synthesis", thesis, Vienna. Abbreviations,
sections and equations in this package refer to it.
"""

from __future__ import annotations

from uplift.scene.representations.registry import FACTORIES, all_representations
from uplift.scene.representations.representation import Representation

__all__ = ["FACTORIES", "Representation", "all_representations"]
