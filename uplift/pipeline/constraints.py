"""Constraints of a cube: atlas entries, then looks, with fitted spectra and the prior that follows from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from uplift import fit
from uplift.common.arrays import Array
from uplift.cube import AtlasTable, EntrySpectra, LeftOut
from uplift.lattice import EntryBoxes
from uplift.models import Model
from uplift.pipeline.entries import MeasuredEntries
from uplift.pipeline.looks import DesignedLooks, LookSet, design_looks
from uplift.pipeline.setting import Setting


@dataclass(frozen=True, eq=False)
class Constraints:
    """The E atlas entries and looks of a cube.

    Parameters
    ----------
    measured : MeasuredEntries
        Atlas entries.
    looks : DesignedLooks
        Looks, which follow the entries.
    at_nodes, at_entries : FittedEntries
        All of them in the spectrum models of nodes and of entries; the same object if the models are.
    model, entry_model : Model
        These models.
    relevance : tuple of float
        Relevance of the families of the library.
    prior : Prior
        Spectra that entries, looks and library let expect.
    """

    measured: MeasuredEntries
    looks: DesignedLooks
    at_nodes: fit.FittedEntries
    at_entries: fit.FittedEntries
    model: Model
    entry_model: Model
    relevance: tuple[float, ...]
    prior: fit.Prior

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the entries and looks."""
        return (*self.measured.names, *self.looks.looks.names)

    @property
    def rgb(self) -> Array:
        """(E, 3) linear RGB."""
        return self.at_nodes.rgb

    def recalculated(self) -> Array:
        """Return multipliers (E, C) of the spectra of entries with the coefficients of nodes.

        Fewer moments of the same spectrum are the first of them (Tódová 2020, section 3.1.3).
        """
        spectra = self._spectra()
        if spectra is None:
            return self.at_nodes.multipliers
        return self.model.from_storage(spectra.coefficients[:, : self.model.count])

    def table(self, boxes: EntryBoxes) -> AtlasTable:
        """Return the part of a cube that records the constraints.

        Parameters
        ----------
        boxes : EntryBoxes
            Regions of the entries.

        Returns
        -------
        AtlasTable
        """
        return AtlasTable(
            self.names,
            self.rgb,
            self.model.to_storage(self.at_nodes.multipliers),
            boxes.half_width,
            np.concatenate([self.at_entries.error[: len(self.measured)], self._look_errors()]),
            self._spectra(),
            self._left_out(),
            len(self.looks.looks),
        )

    def _spectra(self) -> EntrySpectra | None:
        if self.at_entries is self.at_nodes:
            return None
        return EntrySpectra(self.entry_model, self.entry_model.to_storage(self.at_entries.multipliers))

    def _look_errors(self) -> Array:
        """Standard errors (k,) of looks, which no measurement confirms; 0 if the prior states none."""
        rgb = self.looks.looks.rgb
        errors = self.prior.standard_error(rgb) if len(rgb) else None
        return np.zeros(len(rgb)) if errors is None else errors

    def _left_out(self) -> LeftOut | None:
        if self.prior.left_out is None:
            return None
        measured = self.measured.reflectances
        return LeftOut(measured.astype(np.float32), self.prior.left_out.astype(np.float32))


def fit_constraints(
    setting: Setting, measured: MeasuredEntries, wished: LookSet, families: Sequence[fit.Family]
) -> Constraints:
    """Fit atlas entries, learn the prior from them, and design looks as it expects.

    Parameters
    ----------
    setting : Setting
        Sensor, models, lights and solver.
    measured : MeasuredEntries
        Atlas entries.
    wished : LookSet
        Looks.
    families : sequence of Family
        Measured spectra that shape the prior.

    Returns
    -------
    Constraints
    """
    entries = measured.fit(setting, setting.model)
    problem, sensor, lights = setting.problem, setting.sensor, setting.lights
    learnt = fit.learn_base(problem, sensor, lights, families, entries)
    prior = fit.fit_prior(problem, sensor, entries, lights, setting.error_light, learnt.base)
    looks = design_looks(wished, prior, setting.forward, setting.tolerance)
    fitted_looks = _fit_looks(setting, looks, setting.model)
    at_nodes = at_entries = fit.join_entries(entries, fitted_looks)
    if len(at_nodes) and setting.entry_model != setting.model:
        at_entries = fit.join_entries(
            measured.fit(setting, setting.entry_model), _fit_looks(setting, looks, setting.entry_model)
        )
    return Constraints(
        measured,
        looks,
        at_nodes,
        at_entries,
        setting.model,
        setting.entry_model,
        learnt.relevance,
        fit.prior_with_looks(prior, entries, fitted_looks),
    )


def _fit_looks(setting: Setting, looks: DesignedLooks, model: Model) -> fit.FittedEntries:
    return looks.fit(model, setting.sensor, setting.error_light, setting.tolerance)
