"""Interface of base predictors: what the prior expects where no atlas entry is near (docs/mathematics.md, 7)."""

from __future__ import annotations

from typing import Protocol

from uplift.common.arrays import Array


class Base(Protocol):
    """A predictor of spectra from colours alone.

    `uplift.fit.smooth.Smooth` is one. The prior adds to a base the kriged deviation of the atlas entries from it.
    """

    def coefficients(self, rgb: Array) -> Array:
        """Predict the stored coefficients of a model.

        The spectra are nearly of the given colours, as the solver makes them exact. Coefficients of the moments model
        are moments of reflectances in (0, 1), so weighted means of several bases are valid.

        Parameters
        ----------
        rgb : ndarray, shape (n, 3)
            Linear RGB in [0, 1].

        Returns
        -------
        ndarray, shape (n, C)
            Coefficients, continuous in ``rgb``; see `Model.from_storage`.
        """
        ...
