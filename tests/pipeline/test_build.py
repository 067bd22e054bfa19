"""Builds of the ColorChecker and without an atlas, in several sizes and both models."""

import dataclasses
import re

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from threadpoolctl import threadpool_info, threadpool_limits

import uplift
from tests.conftest import MACBETH
from tests.helpers import quiet_build, raises, warns
from uplift.atlas.atlas import Atlas, Entry
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_rgb, delta_e_spectra
from uplift.common.errors import AtlasError, OptionError, UnknownNameError
from uplift.cube.file import digest
from uplift.lattice.point_table import Status
from uplift.pipeline.options import OptionKeywords, Options, check_memory

GRID = observer.grid()


def delta_e(cube, rgb, mode):
    sensor = cube.data.sensor
    back = sensor.rgb(cube.reflectance(rgb, mode=mode))
    return delta_e_rgb(sensor, rgb, back)


OPTIONS = [
    {"dim": 48},
    {"model": "sigmoid"},
    {"coefficients": 3},
    {"coefficients": 17},
    {"warp": "vision"},
]


@pytest.mark.parametrize("atlas", [MACBETH, None], ids=["atlas", "none"])
@pytest.mark.parametrize("options", [*OPTIONS, {"axis": "linear"}], ids=str)
def test_every_point_is_fitted(atlas, options):
    """All nodes are within 1e-4, computed from the stored coefficients only."""
    data = quiet_build(atlas, **{"dim": 12, **options}).data
    spectra = data.model.to_reflectance(
        data.model.from_storage(data.points.coefficients) @ data.model.basis(GRID).T
    )
    assert np.abs(data.sensor.rgb(spectra) - data.lattice.points).max() <= 1e-4
    assert Status.UNFITTED not in data.points.status


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
    atlas = macbeth_cube.data.atlas
    spectra = read_atlas(MACBETH)
    measured = on_grid(spectra, GRID)[
        [spectra.names.index(name) for name in atlas.names]
    ]
    found, without = (
        cube.reflectance(atlas.rgb) for cube in (macbeth_cube, uplift.load())
    )
    assert delta_e(macbeth_cube, atlas.rgb, "spectra").max() <= 0.01
    assert np.sqrt(((found - measured) ** 2).mean(axis=1)).mean() <= 0.02
    error, error_without = (
        delta_e_spectra(observer.light("A"), each, measured).mean()
        for each in (found, without)
    )
    assert error < 0.2 * error_without


def test_entries_out_of_gamut_are_recorded_in_silence():
    with warns():
        cube = uplift.build(MACBETH, dim=8)
    assert "cyan" not in cube.atlas_names
    assert cube.outside_names == ("cyan",)
    assert cube.data.provenance["left_out"] == ["cyan"]
    assert cube.data.provenance["atlases"][0]["name"] == "macbeth.txt"


def test_an_atlas_outside_the_space_is_refused():
    with raises(AtlasError, "atlas-out-of-gamut") as caught:
        uplift.build(Atlas((read_atlas(MACBETH)["cyan"],)), dim=4)
    assert "Display P3" in caught.value.hint


def test_of_entries_of_one_colour_outside_the_space_the_first_is_used():
    cyan = read_atlas(MACBETH)["cyan"]
    twins = Atlas(
        (
            Entry("grey", GRID, np.full(81, 0.4)),
            cyan,
            Entry("second", cyan.wavelengths, cyan.values),
        )
    )
    with warns("entry-duplicate") as caught:
        cube = uplift.build(twins, dim=4, coefficients=5)
    assert "'second'" in caught[0].problem
    assert cube.data.atlas.outside.names == ("cyan",)


def greys(**levels):
    return Atlas(
        tuple(Entry(name, GRID, np.full(81, grey)) for name, grey in levels.items())
    )


def test_crowded_entries_are_warned_about_and_exact():
    with warns("entry-crowded"):
        cube = uplift.build(greys(one=0.2, other=0.24), dim=4)
    assert cube.data.atlas.names == ("one", "other")
    for level in (0.2, 0.24):
        assert_allclose(cube.reflectance([level] * 3), level, atol=1e-4)


def test_duplicate_entries_are_warned_about_and_the_first_is_used():
    bumpy = np.full(81, 0.4) + 0.2 * np.sin(np.arange(81) / 3)
    colour = observer.sensor().rgb(bumpy)
    twins = Atlas((Entry("first", GRID, bumpy), Entry("second", GRID, bumpy)))
    with warns("entry-duplicate") as caught:
        cube = uplift.build(twins, dim=4)
    assert "'second'" in caught[0].problem
    assert cube.data.atlas.names == ("first",)
    own = cube.data.atlas.spectra.reflectance(np.array([0]), GRID)
    assert_allclose(cube.reflectance(colour), own[0], atol=1e-5)


def test_entries_have_more_coefficients_than_nodes():
    """The nodes, and interpolated coefficients, are those of a build with as many."""
    more, same = (
        quiet_build(MACBETH, dim=4, entry_coefficients=count).data for count in (17, 9)
    )
    assert (more.atlas.spectra.model.count, more.model.count) == (17, 9)
    assert same.atlas.spectra.model == same.model
    assert_array_equal(more.points.coefficients, same.points.coefficients)
    assert_array_equal(more.atlas.coefficients, same.atlas.coefficients)
    assert more.atlas.error.mean() < same.atlas.error.mean() / 3
    spectra = more.atlas.spectra.reflectance(np.arange(23), GRID)
    assert_allclose(more.sensor.rgb(spectra), more.atlas.rgb, atol=1e-6)


@pytest.fixture(scope="session")
def in_order():
    return quiet_build(MACBETH, dim=5).data


@settings(max_examples=3, phases=[Phase.generate])
@given(order=st.permutations(range(24)))
def test_the_order_of_the_atlas_changes_only_the_order_of_its_table(in_order, order):
    """Nodes are equal bit by bit, except for the row of their entry; the table is equal
    up to rounding.
    """
    spectra = read_atlas(MACBETH)
    shuffled = quiet_build(
        Atlas(tuple(spectra.entries[row] for row in order)), dim=5
    ).data
    for name in ("coefficients", "rgb", "distance", "status", "standard_error"):
        assert (
            getattr(shuffled.points, name).tobytes()
            == getattr(in_order.points, name).tobytes()
        )
    assert shuffled.provenance["prior"] == in_order.provenance["prior"]
    row = [shuffled.atlas.names.index(name) for name in in_order.atlas.names]
    for name in ("rgb", "coefficients", "half_width", "error"):
        assert_allclose(
            getattr(shuffled.atlas, name)[row],
            getattr(in_order.atlas, name),
            rtol=1e-12,
            atol=1e-13,
        )
    assert_array_equal(np.append(row, -1)[in_order.points.entry], shuffled.points.entry)


def test_builds_do_not_depend_on_batches(monkeypatch):
    """In a wide gamut, where some nodes need many iterations."""
    options = {"dim": 7, "space": "ITU-R BT.2020"}
    as_it_is = quiet_build(MACBETH, **options).data
    monkeypatch.setattr("uplift.fit.batch.CPU_ROWS", (1024, 256))
    assert digest(quiet_build(MACBETH, **options).data) == digest(as_it_is)


def test_builds_do_not_depend_on_threads():
    """The atlas is large enough for BLAS to use several threads."""
    spectra = read_atlas(
        MACBETH.with_name("cie2017.txt"), MACBETH.with_name("babelcolor.txt")
    )
    digests = set()
    for threads in (1, 4):
        with threadpool_limits(threads, user_api="blas"):
            digests.add(digest(quiet_build(spectra, dim=3).data))
            assert {
                pool["num_threads"]
                for pool in threadpool_info()
                if pool["user_api"] == "blas"
            } == {threads}
    assert len(digests) == 1


@pytest.mark.parametrize(
    ("options", "error", "code"),
    [
        ({"dim": 1}, OptionError, "option"),
        ({"dim": 10**400}, OptionError, "out-of-memory"),
        ({"threshold": float("nan")}, OptionError, "option"),
        ({"entry_coefficients": 8}, OptionError, "option"),
        ({"model": "moment"}, UnknownNameError, "unknown-name"),
        ({"space": "sRGBB"}, UnknownNameError, "unknown-name"),
        ({"illuminant": "D56"}, UnknownNameError, "unknown-name"),
        ({"lights": ("D65", "FL111")}, UnknownNameError, "unknown-name"),
        ({"solver": "newton"}, UnknownNameError, "unknown-name"),
        ({"shortest": 299}, OptionError, "option"),
        ({"longest": 830, "step": 10, "shortest": 375}, OptionError, "option"),
        (
            {"step": 10, "space": "camera", "observer": "Nikon 5100 (NPL)"},
            OptionError,
            "option",
        ),
        ({"warp": "visions"}, UnknownNameError, "unknown-name"),
        ({"prior": "flat"}, UnknownNameError, "unknown-name"),
        ({"neutral": "grey"}, UnknownNameError, "unknown-name"),
        ({"leave_out": ["absent"]}, UnknownNameError, "unknown-name"),
        ({"neutral": "flat", "growth": "neighbours"}, OptionError, "option"),
        *(
            ({"library": MACBETH, **options}, OptionError, "option")
            for options in (
                {"prior": "smooth"},
                {"model": "sigmoid"},
                {"coefficients": 3},
            )
        ),
        ({"scene": []}, OptionError, "option"),
    ],
)
def test_bad_options_are_refused_before_anything_is_fitted(
    options, error, code, monkeypatch
):
    monkeypatch.setattr(
        "uplift.pipeline.entries.fit_entries", lambda *_, **__: pytest.fail("fitted")
    )
    with raises(error, code):
        uplift.build(MACBETH, **options)


def test_keywords_of_build_are_the_options():
    """Editors complete them, and `Options` has their defaults."""
    names = [field.name for field in dataclasses.fields(Options)]
    assert list(OptionKeywords.__annotations__) == names
    both = (
        uplift.build(dim=3, coefficients=5),
        uplift.build(None, Options(dim=3, coefficients=5)),
    )
    assert digest(both[0].data) == digest(both[1].data)
    assert uplift.build(None, Options(coefficients=5), dim=2).dim == 2
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
