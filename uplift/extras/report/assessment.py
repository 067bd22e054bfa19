"""Quality of a cube: errors of its lattice, of random colours and of atlas entries."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from uplift.atlas.atlas import Atlas
from uplift.colorimetry.illuminants import Illuminant
from uplift.colorimetry.observer import display_sensors
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array, Values
from uplift.cube.data import CubeData
from uplift.cube.file import summarise
from uplift.extras.colour.light_sets import REPORT_LIGHTS
from uplift.extras.report import measures
from uplift.extras.report.charts import (
    Histogram,
    linear_edges,
    log_edges,
    make_histogram,
)
from uplift.extras.report.comparison import SpectraComparison
from uplift.extras.report.crowding import Crowding, find_crowding
from uplift.extras.report.entries import (
    Entries,
    EntryErrors,
    entry_errors,
    find_alternatives,
    other_entries,
    own_entries,
)
from uplift.extras.report.measures import Calibration, check_calibration
from uplift.lookup.cube import Cube

MIN_ERROR = 1e-9
"""Smaller distances and ΔE00 are rounding errors and are counted in the lowest bin."""
MIN_STEP = 1e-4
"""Smaller rms differences of reflectance are counted in the lowest bin."""


@dataclass(frozen=True, eq=False)
class Assessment:
    """Quality of one cube, by its own lattice and by measured spectra. Measures are
    computed when they are asked for.
    """

    cube: Cube
    name: str
    """Base name of the file of the cube."""
    size: int
    """Bytes of the file."""
    atlas: Atlas
    """Measured spectra, which may be none."""
    lights: tuple[Sensor, ...]
    """Display sensors of the lights under which entries are compared."""

    @property
    def data(self) -> CubeData:
        """The cube."""
        return self.cube.data

    @cached_property
    def facts(self) -> dict[str, Any]:
        """Facts that ``uplift info`` shows."""
        return summarise(self.data)

    @cached_property
    def failures(self) -> dict[str, Any]:
        """Nodes over the threshold and missing entries: `measures.collect_failures`."""
        return measures.collect_failures(self.data)

    @cached_property
    def distance(self) -> Histogram:
        """Fitting distance of the nodes, max |linear RGB|."""
        distances = self.data.points.distance[self.data.points.present]
        return make_histogram(distances, log_edges(distances, MIN_ERROR))

    @cached_property
    def round_trips(self) -> dict[str, Histogram]:
        """ΔE00 of random colours under the cube's illuminant, by mode of lookup."""
        errors = measures.round_trip_errors(self.cube)
        return _comparable(errors, lambda values: log_edges(values, MIN_ERROR))

    @cached_property
    def standard_error(self) -> Histogram | None:
        """Standard errors of the nodes that lookups reach, ΔE00 under
        ``data.error_illuminant``; None if the cube has none.
        """
        nodes = self.data.lattice.points[self.data.points.present]
        errors = self.cube.standard_error(nodes[self.cube.covers(nodes)])
        return None if errors is None else make_histogram(errors, linear_edges(errors))

    @cached_property
    def _smoothness(self) -> tuple[Values, Array]:
        return measures.compute_smoothness(self.data)

    @cached_property
    def smoothness(self) -> Histogram:
        """Rms difference of reflectance between neighbouring nodes."""
        differences, _ = self._smoothness
        return make_histogram(differences, log_edges(differences, MIN_STEP))

    @property
    def steepest(self) -> Array:
        """(2, 3) linear RGB of the two neighbours that differ most."""
        return self._smoothness[1]

    @property
    def sources(self) -> tuple[str, ...]:
        """Names of the files that the measured spectra come from."""
        return tuple(source.name for source in self.atlas.sources)

    @property
    def own(self) -> bool:
        """Whether the cube records the digests of all these files."""
        recorded = self.data.provenance.get("atlases", ())
        digests = {str(source.get("digest")) for source in recorded}
        given = {source.digest for source in self.atlas.sources}
        return bool(given) and given <= digests

    @property
    def _lights(self) -> list[Light]:
        return [sensor.light for sensor in self.lights]

    @cached_property
    def _queried(self) -> Entries | None:
        """Entries inside the RGB space, or stored."""
        if not self.atlas.entries:
            return None
        query = own_entries if self.own else other_entries
        return query(self.data, self.atlas)

    @cached_property
    def entries(self) -> EntryErrors | None:
        """Errors of the entries; None without a measured spectrum to compare with."""
        if self._queried is None:
            return None
        return entry_errors(self.cube, self._queried, self._lights)

    @property
    def out_of_gamut(self) -> tuple[str, ...]:
        """Entries of ``sources`` outside the cube's RGB space."""
        return _missing(self.atlas.names, self._queried)

    @property
    def not_covered(self) -> tuple[str, ...]:
        """Entries of ``sources`` for which a sparse cube has no nodes."""
        return (
            () if self._queried is None else _missing(self._queried.names, self.entries)
        )

    @cached_property
    def alternatives(self) -> dict[str, SpectraComparison]:
        """Errors of other methods at the colours of ``entries``."""
        if self.entries is None:
            return {}
        return find_alternatives(self.data, self.entries, self._lights)

    @cached_property
    def delta_e(self) -> dict[str, Histogram]:
        """ΔE00 of the entries by name of the light."""
        if self.entries is None:
            return {}
        columns = self.entries.answers.delta_e.T
        errors = dict(zip(self.entries.answers.lights, columns, strict=True))
        return _comparable(errors, linear_edges)

    @property
    def _unseen(self) -> EntryErrors | None:
        """Entries that show whether standard errors hold."""
        return None if self.own else self.entries

    @cached_property
    def calibration(self) -> Calibration | None:
        """Actual against predicted errors; None if the cube was built from the entries
        or has no standard errors.
        """
        if (unseen := self._unseen) is None:
            return None
        bound = self.cube.error_bound(unseen.rgb)
        return check_calibration(unseen.actual, unseen.predicted, bound)

    @cached_property
    def light_calibrations(self) -> dict[str, Calibration]:
        """The same under the other of ``lights``, but not that of the build; empty
        without ``calibration``, and for cubes of earlier versions.
        """
        unseen = self._unseen
        if unseen is None or not self.calibration or self.data.atlas.left_out is None:
            return {}
        calibrations = {}
        for light, actual in zip(
            unseen.answers.lights, unseen.answers.delta_e.T, strict=True
        ):
            if light in (self.data.error_illuminant, self.data.sensor.illuminant):
                continue
            predicted = self.cube.standard_error(unseen.rgb, light)
            bound = self.cube.error_bound(unseen.rgb, light)
            if calibration := check_calibration(actual, predicted, bound):
                calibrations[light] = calibration
        return calibrations

    @property
    def unlike(self) -> float:
        """Share of the entries whose colours are unlike those of the cube's atlas; 0
        without ``calibration``.
        """
        if self._unseen is None or not self.calibration:
            return 0.0
        return float(self.cube.unlike_atlas(self._unseen.rgb).mean())

    @cached_property
    def crowding(self) -> Crowding | None:
        """Close entries of the cube, None if it has no entries. Errors are relative to
        the measured spectra if ``own``, otherwise relative to the stored ones.
        """
        errors = self.entries if self.own else None
        if errors is None:
            errors = entry_errors(self.cube, own_entries(self.data), self._lights)
        return None if errors is None else find_crowding(self.data, errors)


def assess(
    cube: Cube,
    name: str,
    size: int,
    atlas: Atlas | None,
    lights: Sequence[Illuminant] = REPORT_LIGHTS,
) -> Assessment:
    """Assess a cube by its own lattice and, if given, by measured spectra."""
    data = cube.data
    sensors = display_sensors(lights, data.sensor.observer, *data.sensor.range)
    return Assessment(cube, name, size, atlas or Atlas(), sensors)


def _missing(
    names: Sequence[str], present: Entries | EntryErrors | None
) -> tuple[str, ...]:
    known = set() if present is None else set(present.names)
    return tuple(name for name in names if name not in known)


def _comparable(
    values: Mapping[str, Array], edges: Callable[[Array], Array]
) -> dict[str, Histogram]:
    """Histograms with common edges."""
    common = edges(np.concatenate(list(values.values())))
    return {name: make_histogram(array, common) for name, array in values.items()}
