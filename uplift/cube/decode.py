"""The content of a cube from the arrays and the metadata of its file, after a check."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from uplift.colorimetry.likely_errors import LeftOut
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Indices
from uplift.common.text import pluralise
from uplift.cube.container import (
    Stored,
    Tensors,
    check_arrays,
    check_metadata,
    check_wavelengths,
    require,
)
from uplift.cube.data import AtlasTable, CubeData, EntrySpectra
from uplift.cube.schema import (
    ARRAYS,
    ENTRY_COEFFICIENTS,
    FAMILIES,
    METADATA,
    POINTS,
    SENSOR,
)
from uplift.lattice.lattice import CORNERS, Lattice
from uplift.lattice.point_table import PointTable
from uplift.models.model import Model
from uplift.models.registry import from_description

MAX_POINTS = 1 << 27
"""Nodes of the largest lattice of a sparse file, as a small file must not claim all
memory.
"""
MAX_CONDITION = 1e6
"""Limit of the condition number of the matrix from XYZ to RGB."""


def decode(tensors: Tensors, metadata: dict[str, Any]) -> CubeData:
    """Make the cube of a file after a check of types and ranges, of metadata first,
    then of arrays.
    """
    check_metadata(metadata, METADATA)
    model, entry_model = _models(metadata)
    schema = _schema(metadata["features"], is_shared=entry_model == model)
    check_arrays(tensors, schema, _sizes(tensors, metadata, model, entry_model))
    arrays: dict[str, Any] = {name: tensors[name] for name in schema}
    data = CubeData(
        model=model,
        lattice=Lattice(arrays["nodes"]),
        sensor=_sensor(arrays, metadata),
        threshold=float(metadata["threshold"]),
        error_illuminant=metadata["reference"],
        atlas=_atlas(arrays, metadata, entry_model),
        provenance=metadata["provenance"],
        points=PointTable(**{name: arrays[name] for name in POINTS if name in arrays}),
        families=_families(arrays, metadata["provenance"]),
    )
    require(
        metadata["dim"] == data.lattice.dim,
        f"dim must be {data.lattice.dim}, the number of nodes",
    )
    _check(data)
    if "points" in arrays:
        numbers = arrays["points"].astype(np.int64)
        data = replace(data, points=_expand(data.points, numbers, data.lattice))
    size = data.lattice.size
    count = data.points.status.size
    require(count == size, f"there must be {pluralise(size, 'node')}, got {count}")
    return data


def _models(metadata: dict[str, Any]) -> tuple[Model, Model]:
    """Return the models of nodes and of entries, which differ in their counts only."""
    model = from_description(metadata["model"])
    entry_model = from_description(metadata["entry_model"])
    uncounted = metadata["model"] | {"count": None}
    entry_uncounted = metadata["entry_model"] | {"count": None}
    require(
        uncounted == entry_uncounted and entry_model.count >= model.count,
        "the model of the entries must extend that of the nodes",
    )
    return model, entry_model


def _schema(features: list[str], is_shared: bool) -> dict[str, Stored]:
    """Return the arrays of a file, where nodes and entries may share one model."""
    return {
        name: stored
        for name, stored in ARRAYS.items()
        if stored.feature in ("", *features)
        and not (is_shared and name.endswith(ENTRY_COEFFICIENTS))
    }


def _sizes(
    tensors: Tensors, metadata: dict[str, Any], model: Model, entry_model: Model
) -> dict[str, int]:
    """Return the lengths that the letters of shapes stand for."""
    count = len(metadata["entries"])
    provenance = metadata["provenance"]
    return {
        "C": model.count,
        "K": entry_model.count,
        "E": count,
        "M": count - len(provenance.get("looks", ())),
        "O": len(provenance.get("left_out", ())),
        "D": tensors["nodes"].size,
        "F": np.size(tensors.get("families.family", ())),
        "n": tensors["status"].size,
        "N": tensors["sensor.wavelengths"].size,
    }


def _sensor(arrays: dict[str, Any], metadata: dict[str, Any]) -> Sensor:
    columns: dict[str, Any] = {name: arrays.get(f"sensor.{name}") for name in SENSOR}
    return Sensor(
        metadata["space"], metadata["illuminant"], metadata["observer"], **columns
    )


def _atlas(
    arrays: dict[str, Any], metadata: dict[str, Any], model: Model
) -> AtlasTable:
    provenance = metadata["provenance"]
    table = _table(arrays, "atlas", metadata["entries"], model)
    outside = None
    if "outside.rgb" in arrays:
        outside = _table(arrays, "outside", provenance.get("left_out", ()), model)
    return replace(
        table,
        left_out=arrays.get("atlas.left_out"),
        looks=len(provenance.get("looks", ())),
        outside=outside,
    )


def _families(arrays: dict[str, Any], provenance: dict[str, Any]) -> LeftOut | None:
    if "families.family" not in arrays:
        return None
    columns = {name: arrays[f"families.{name}"] for name in FAMILIES}
    return LeftOut(**columns, names=tuple(provenance.get("left_out_families", ())))


def _table(
    arrays: dict[str, Any], prefix: str, names: Iterable[str], model: Model
) -> AtlasTable:
    coefficients = arrays[f"{prefix}.coefficients"]
    # Entries with as many coefficients as nodes have them once.
    entry_coefficients = arrays.get(f"{prefix}.{ENTRY_COEFFICIENTS}", coefficients)
    return AtlasTable(
        names=tuple(names),
        rgb=arrays[f"{prefix}.rgb"],
        coefficients=coefficients,
        half_width=arrays[f"{prefix}.reach"],
        error=arrays[f"{prefix}.error"],
        spectra=EntrySpectra(model, entry_coefficients),
        measured=arrays.get(f"{prefix}.measured"),
    )


def _check(data: CubeData) -> None:
    """Check what a lookup relies on beyond types and ranges. The nodes of a sparse cube
    are those in its file.
    """
    atlas = data.atlas
    sensor = data.sensor
    nodes = data.lattice.nodes
    check_wavelengths(sensor.wavelengths)
    names = atlas.names + (atlas.outside.names if atlas.outside else ())
    looks = tuple(look["name"] for look in data.provenance.get("looks", ()))
    options = data.provenance.get("options", {})
    with np.errstate(all="ignore"):
        basis = data.model.basis(sensor.wavelengths)
        white = sensor.matrix.sum(axis=1)
        channels = (sensor.xyz_to_rgb, sensor.light.xyz, sensor.matrix)
        regular = all(map(_has_three_channels, channels))
    shape = (len(sensor.wavelengths), data.model.count)
    for condition_met, problem in (
        (len(set(names)) == len(names), "the names of entries must be unique"),
        (
            looks == atlas.names[atlas.measured_count :],
            "the looks must be the last entries, by their names",
        ),
        (
            atlas.left_out is None or atlas.measured_count,
            "left-out spectra need entries",
        ),
        (
            all(map(_is_option, options.values())),
            "metadata.provenance.options must be text, numbers and names",
        ),
        (
            basis.shape == shape and np.isfinite(basis).all(),
            "the model must have a range of wavelengths",
        ),
        ((nodes[0], nodes[-1]) == (0, 1), "the nodes must run from 0 to 1"),
        (
            data.points.entry.max(initial=-1) < len(atlas.names),
            "every entry must be in the atlas table",
        ),
        (
            (np.abs(white - 1) <= 1e-6).all(),
            "the perfect reflector must have RGB (1, 1, 1)",
        ),
        (
            regular,
            "observer, RGB space and camera must have three independent channels",
        ),
        (
            (np.diff(sensor.decoding) >= 0).all(),
            "the decoding of 8-bit codes must not decrease",
        ),
    ):
        require(bool(condition_met), problem)


def _is_option(value: Any) -> bool:
    """Return whether a value has the type of an option: lamps have a name."""
    items = value if isinstance(value, list) else [value]
    names = [item.get("name") if isinstance(item, dict) else item for item in items]
    return all(isinstance(name, str | int | float) for name in names)


def _has_three_channels(matrix: Array) -> bool:
    """Return whether the rows (3, …) of a matrix are independent of each other."""
    is_finite = bool(np.isfinite(matrix).all())
    return is_finite and bool(np.linalg.cond(matrix) < MAX_CONDITION)


def _expand(points: PointTable, numbers: Indices, lattice: Lattice) -> PointTable:
    """Expand the rows (m, …) of the nodes ``numbers`` (m,) to those of the lattice, (n,
    …).
    """
    size = lattice.size
    valid = 0 < len(numbers) < size <= MAX_POINTS and numbers[-1] < size
    valid = valid and (np.diff(numbers) > 0).all()
    require(
        bool(valid), "point numbers must ascend within the lattice, with some missing"
    )
    # A query needs the lowest and the highest corner of a cell, and two between.
    low = numbers[(lattice.position(numbers) < lattice.dim - 1).all(axis=-1)]
    has_highest = np.isin(low + lattice.index(CORNERS[-1]), numbers, assume_unique=True)
    require(
        bool(has_highest.any()), "one cell must have its lowest and highest corners"
    )
    return points.spread(numbers, size)
