"""Builds of the ColorChecker and without an atlas, in several sizes and both models."""

import dataclasses
import re

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from threadpoolctl import threadpool_limits

import uplift
from tests.conftest import ATLASES, MACBETH
from tests.helpers import quiet_build, raises, warns
from uplift.atlas.atlas import Atlas, Entry
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_rgb, delta_e_spectra
from uplift.colorimetry.sensor import in_unit_cube
from uplift.common.errors import AtlasError, OptionError, UpliftError
from uplift.cube.file import digest
from uplift.lattice.point_table import Status
from uplift.models.model import reflectance
from uplift.pipeline.options import OptionKeywords, Options, check_memory

GRID = observer.grid()


def delta_e(cube, rgb, mode):
    sensor = cube.data.sensor
    back = sensor.rgb(cube.reflectance(rgb, mode=mode))
    return delta_e_rgb(sensor, rgb, back)


def atlas_of(**spectra):
    return Atlas(tuple(Entry(name, GRID, values) for name, values in spectra.items()))


@pytest.mark.parametrize(
    ("atlas", "options"),
    [
        (None, {"threshold": 1e-8}),
        (MACBETH, {"model": "sigmoid"}),
        (MACBETH, {"coefficients": 3}),
        (MACBETH, {"coefficients": 17}),
        (MACBETH, {"warp": "vision"}),
        (MACBETH, {"axis": "linear"}),
    ],
    ids=str,
)
def test_every_point_is_fitted(atlas, options):
    """To the threshold, computed from the stored coefficients only, which are single
    precision where that suffices.
    """
    data = quiet_build(atlas, dim=8, **options).data
    spectra = reflectance(data.model, data.points.coefficients, GRID)
    off = np.abs(data.sensor.rgb(spectra) - data.lattice.points)
    assert off.max() <= data.threshold
    assert Status.UNFITTED not in data.points.status
    assert data.points.coefficients.dtype == ("f8" if "threshold" in options else "f4")


@pytest.mark.parametrize(
    ("mode", "mean", "most"),
    [("spectra", 1e-4, 0.05), ("moments", 0.02, np.inf), ("refined", 1e-3, 0.05)],
)
def test_20000_random_colours_have_small_round_trip_errors(
    macbeth_cube, mode, mean, most
):
    apart = delta_e(macbeth_cube, np.random.default_rng(20000).random((20000, 3)), mode)
    assert apart.mean() <= mean
    assert apart.max() <= most


def test_entries_have_their_measurements_and_so_better_colours_under_other_lights(
    macbeth_cube,
):
    rgb = macbeth_cube.data.atlas.rgb
    measured = on_grid(read_atlas(MACBETH), GRID)
    measured = measured[in_unit_cube(macbeth_cube.data.sensor.rgb(measured))]
    found, without = (cube.reflectance(rgb) for cube in (macbeth_cube, uplift.load()))
    assert delta_e(macbeth_cube, rgb, "spectra").max() <= 0.01
    assert np.sqrt(((found - measured) ** 2).mean(axis=1)).mean() <= 0.02
    error, error_without = (
        delta_e_spectra(observer.light("A"), spectra, measured).mean()
        for spectra in (found, without)
    )
    assert error < 0.2 * error_without


def test_entries_out_of_gamut_are_recorded_in_silence():
    with warns():
        data = uplift.build(MACBETH, dim=8).data
    assert "cyan" not in data.atlas.names
    assert data.atlas.outside.names == ("cyan",)
    assert data.provenance["left_out"] == ["cyan"]


def test_an_atlas_outside_the_space_is_refused():
    with raises(AtlasError, "atlas-out-of-gamut") as caught:
        uplift.build(Atlas((read_atlas(MACBETH)["cyan"],)), dim=4)
    assert "Display P3" in caught.value.hint


def test_crowded_entries_are_warned_about_and_exact():
    with warns("entry-crowded"):
        cube = uplift.build(
            atlas_of(one=np.full(81, 0.2), other=np.full(81, 0.24)), dim=4
        )
    assert cube.data.atlas.names == ("one", "other")
    for level in (0.2, 0.24):
        assert_allclose(cube.reflectance([level] * 3), level, atol=1e-4)


def test_of_entries_of_one_colour_the_first_is_used_with_a_warning():
    """Also outside the space."""
    bumpy = np.full(81, 0.4) + 0.2 * np.sin(np.arange(81) / 3)
    cyan = on_grid(read_atlas(MACBETH), GRID)[17]
    with warns("entry-duplicate") as caught:
        cube = uplift.build(
            atlas_of(first=bumpy, second=bumpy, cyan=cyan, third=cyan), dim=4
        )
    assert "'second', 'third'" in caught[0].problem
    assert (cube.atlas_names, cube.outside_names) == (("first",), ("cyan",))
    own = cube.data.atlas.spectra.reflectance(np.array([0]), GRID)
    assert_allclose(cube.reflectance(cube.data.sensor.rgb(bumpy)), own[0], atol=1e-5)


def test_entries_have_more_coefficients_than_nodes():
    """The nodes, and interpolated coefficients, are those of a build with as many."""
    more, same = (
        quiet_build(MACBETH, dim=4, entry_coefficients=count).data for count in (17, 9)
    )
    assert more.atlas.spectra.model.count == 17
    assert same.atlas.spectra.model == same.model == more.model
    assert_array_equal(more.points.coefficients, same.points.coefficients)
    assert_array_equal(more.atlas.coefficients, same.atlas.coefficients)
    assert more.atlas.error.mean() < same.atlas.error.mean() / 3


@pytest.fixture(scope="module")
def in_order():
    return quiet_build(MACBETH, dim=5).data


@settings(max_examples=2, phases=[Phase.generate])
@given(order=st.permutations(range(24)))
def test_the_order_of_the_atlas_changes_only_the_order_of_its_table(in_order, order):
    """Nodes are equal bit by bit, the table up to rounding."""
    entries = read_atlas(MACBETH).entries
    shuffled = quiet_build(Atlas(tuple(entries[row] for row in order)), dim=5).data
    for name in ("coefficients", "rgb", "distance", "status", "standard_error"):
        one, other = (getattr(data.points, name) for data in (in_order, shuffled))
        assert one.tobytes() == other.tobytes(), name
    row = [shuffled.atlas.names.index(name) for name in in_order.atlas.names]
    assert_array_equal(np.append(row, -1)[in_order.points.entry], shuffled.points.entry)
    for name in ("rgb", "coefficients", "half_width", "error"):
        one, other = (getattr(data.atlas, name) for data in (in_order, shuffled))
        assert_allclose(other[row], one, rtol=1e-12, atol=1e-13)


def test_builds_do_not_depend_on_batches(monkeypatch):
    """In a wide gamut, where some nodes need many iterations."""
    options = {"dim": 4, "space": "ITU-R BT.2020"}
    as_it_is = quiet_build(MACBETH, **options).data
    monkeypatch.setattr("uplift.fit.batch.CPU_ROWS", (1024, 256))
    assert digest(quiet_build(MACBETH, **options).data) == digest(as_it_is)


def test_builds_do_not_depend_on_threads():
    """The atlas is large enough for BLAS to use several threads."""
    spectra = read_atlas(ATLASES / "cie2017.txt", ATLASES / "babelcolor.txt")
    digests = set()
    for threads in (1, 4):
        with threadpool_limits(threads, user_api="blas"):
            digests.add(digest(quiet_build(spectra, dim=3).data))
    assert len(digests) == 1


@pytest.mark.parametrize(
    ("code", "options"),
    [
        ("option", {"dim": 1}),
        ("out-of-memory", {"dim": 10**400}),
        ("option", {"threshold": float("nan")}),
        ("option", {"entry_coefficients": 8}),
        ("unknown-name", {"model": "moment"}),
        ("unknown-name", {"space": "sRGBB"}),
        ("unknown-name", {"illuminant": "D56"}),
        ("unknown-name", {"lights": ("D65", "FL111")}),
        ("unknown-name", {"solver": "newton"}),
        ("option", {"shortest": 299}),
        ("option", {"longest": 830, "step": 10, "shortest": 375}),
        ("option", {"step": 10, "space": "camera", "observer": "Nikon 5100 (NPL)"}),
        ("unknown-name", {"warp": "visions"}),
        ("unknown-name", {"prior": "flat"}),
        ("unknown-name", {"neutral": "grey"}),
        ("unknown-name", {"leave_out": ["absent"]}),
        ("option", {"neutral": "flat", "growth": "neighbours"}),
        ("option", {"library": MACBETH, "prior": "smooth"}),
        ("option", {"library": MACBETH, "model": "sigmoid"}),
        ("option", {"library": MACBETH, "coefficients": 3}),
        ("option", {"scene": []}),
    ],
)
def test_bad_options_are_refused_before_anything_is_fitted(code, options, monkeypatch):
    monkeypatch.setattr(
        "uplift.pipeline.entries.fit_entries", lambda *_, **__: pytest.fail("fitted")
    )
    with raises(UpliftError, code):
        uplift.build(MACBETH, **options)


def test_keywords_of_build_are_the_options():
    """Editors complete them, and `Options` has their defaults."""
    names = [field.name for field in dataclasses.fields(Options)]
    assert list(OptionKeywords.__annotations__) == names
    assert uplift.build(None, Options(prior="smooth"), dim=2).dim == 2
    with pytest.raises(TypeError, match="dimm"):
        uplift.build(dimm=3)  # type: ignore[call-arg]


def test_the_dim_that_an_error_names_fits_into_free_memory(monkeypatch):
    monkeypatch.setattr("uplift.common.machine.free_memory", lambda: 2_000_000_000)
    with raises(OptionError, "out-of-memory") as caught:
        check_memory(Options(dim=3000))
    largest = int(re.search(r"dim=(\d+)", caught.value.hint)[1])
    check_memory(Options(dim=largest))
    with raises(OptionError, "out-of-memory"):
        check_memory(Options(dim=largest + 1))


@pytest.mark.parametrize("atlas", [np.ones((3, 81)), {"a": 1}, 3, ["macbeth", 3]])
def test_what_is_not_an_atlas_has_an_error_that_helps(atlas):
    with raises(AtlasError, "atlas") as caught:
        uplift.build(atlas, dim=4)
    assert "Entry" in caught.value.hint
