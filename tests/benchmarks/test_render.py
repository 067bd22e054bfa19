"""The rendered ColorChecker, small and noisy: layout, reference, errors."""

# ruff: noqa: E402  (what follows imports Mitsuba)
from __future__ import annotations

import numpy as np
import pytest

from tests.parts import MITSUBA, need

need(MITSUBA)

from benchmarks.render import __main__ as demo
from benchmarks.render import scene
from benchmarks.render.chart import Layout, chart
from benchmarks.render.picture import draw
from uplift.colorimetry.observer import light

LAYOUT, SPP = Layout(patch=4, gap=2), 32


@pytest.fixture(scope="module")
def painted():
    return chart()


@pytest.fixture(scope="module")
def renders(painted, repository):
    """All methods under all lights; Mitsuba's own uplift stands in for the cubes that are not stored."""
    scene.start()
    methods = {
        demo.REFERENCE: scene.measured(painted),
        **dict.fromkeys((demo.MITSUBA, demo.PLAIN, demo.ATLAS_17), scene.built_in(painted)),
        demo.ATLAS: scene.from_cube(painted, str(repository / "cubes" / "moments-8-macbeth.uplift")),
    }
    return demo.render(methods, LAYOUT, SPP)


def test_24_patches_do_not_overlap():
    width, height = LAYOUT.size
    image = np.zeros((height, width))
    for place in LAYOUT.patches():
        image[place] += 1
    assert image.max() == 1
    assert image.sum() == 24 * LAYOUT.patch**2
    assert sum(image[place].size for place in LAYOUT.patches(inset=1)) == 24 * (LAYOUT.patch - 2) ** 2


def test_only_cyan_is_outside_srgb(painted):
    assert [name for name, outside in zip(painted.names, painted.outside, strict=True) if outside] == ["cyan"]
    assert painted.painted.min() == 0


def test_reference_equals_the_integral_of_the_measured_spectra(painted, renders):
    for name in demo.LIGHTS:
        expected = painted.measured @ light(name).xyz.T
        found = LAYOUT.means(renders.images[name, demo.REFERENCE])
        np.testing.assert_allclose(found.mean(axis=0), expected.mean(axis=0), rtol=0.03)
        np.testing.assert_allclose(found[:, 1], expected[:, 1], rtol=0.1)


def test_cube_with_atlas_has_less_than_half_the_error_of_mitsuba(painted, renders):
    for name in demo.LIGHTS[1:]:
        cube, mitsuba = (
            renders.delta_e[name, method][~painted.outside].mean() for method in (demo.ATLAS, demo.MITSUBA)
        )
        assert cube < mitsuba / 2


def test_patches_are_where_the_layout_places_them(renders):
    image = renders.images["D65", demo.REFERENCE]
    means = LAYOUT.means(image)
    for place, mean in zip(LAYOUT.patches(), means, strict=True):
        assert image[place][..., 1].std() < 0.1 * mean[1]


def test_figures_summarise_the_errors(painted, renders):
    figures = demo.figures(painted, renders)
    mitsuba, cube = (renders.delta_e["A", method] for method in (demo.MITSUBA, demo.ATLAS))
    (ratio,) = [row for row in figures["ratios"] if row["light"] == "A"]
    assert ratio["all"] == pytest.approx(mitsuba.mean() / cube.mean())
    assert ratio["in_gamut"] > ratio["all"]
    assert [row["patch"] for row in figures["patches"]] == list(painted.names)
    assert figures["patches"][3]["A"] == {"mitsuba": mitsuba[3], "cube": cube[3]}
    (noise,) = [row for row in figures["means"] if row["method"] == demo.OTHER_SEED]
    assert noise["FL11"][0] == pytest.approx(renders.delta_e["FL11", demo.OTHER_SEED].mean())


def test_picture_is_written_as_png(renders, tmp_path):
    captions = dict.fromkeys(renders.images, "mean ΔE00")
    draw(renders.images, captions, demo.LIGHTS, demo.DRAWN, LAYOUT, tmp_path / "charts.png")
    assert (tmp_path / "charts.png").read_bytes().startswith(b"\x89PNG")
