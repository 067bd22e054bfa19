"""The rendered ColorChecker, small and noisy: what is drawn where, and that the truth is the truth."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("mitsuba")

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
    """Every way under every light, but that Mitsuba's own stands for cubes other than the stored one."""
    scene.start()
    ways = {
        demo.TRUTH: scene.measured(painted),
        **dict.fromkeys((demo.BUILT_IN, demo.PLAIN, demo.ATLAS_17), scene.built_in(painted)),
        demo.ATLAS: scene.from_cube(painted, str(repository / "cubes" / "moments-8-macbeth.uplift")),
    }
    return demo.render(ways, LAYOUT, SPP)


def test_patches_are_24_and_apart():
    width, height = LAYOUT.size
    image = np.zeros((height, width))
    for place in LAYOUT.patches():
        image[place] += 1
    assert image.max() == 1
    assert image.sum() == 24 * LAYOUT.patch**2
    assert sum(image[place].size for place in LAYOUT.patches(inset=1)) == 24 * (LAYOUT.patch - 2) ** 2


def test_srgb_holds_all_but_cyan(painted):
    assert [name for name, outside in zip(painted.names, painted.outside, strict=True) if outside] == ["cyan"]
    assert painted.painted.min() == 0


def test_the_truth_is_what_the_spectra_integrate_to(painted, renders):
    for name in demo.LIGHTS:
        expected = painted.measured @ light(name).xyz.T
        found = LAYOUT.means(renders.images[name, demo.TRUTH])
        np.testing.assert_allclose(found.mean(axis=0), expected.mean(axis=0), rtol=0.03)
        np.testing.assert_allclose(found[:, 1], expected[:, 1], rtol=0.1)


def test_the_atlas_tells(painted, renders):
    for name in demo.LIGHTS[1:]:
        ours, own = (renders.apart[name, way][~painted.outside].mean() for way in (demo.ATLAS, demo.BUILT_IN))
        assert ours < own / 2


def test_patches_lie_where_the_layout_says(renders):
    image = renders.images["D65", demo.TRUTH]
    means = LAYOUT.means(image)
    for place, mean in zip(LAYOUT.patches(), means, strict=True):
        assert image[place][..., 1].std() < 0.1 * mean[1]


def test_the_page_says_what_was_found(painted, renders):
    text = demo.introduction(painted, renders, LAYOUT, SPP)
    ratio = renders.apart["A", demo.BUILT_IN].mean() / renders.apart["A", demo.ATLAS].mean()
    assert f"{ratio:.1f} times under A" in text
    assert f"{16 * SPP:,} samples" in text
    assert demo.patches_table(painted, renders).count("\n| ") == 2 + 24
    assert f"{renders.apart['FL11', demo.AGAIN].mean():.2f}" in demo.means_table(painted, renders)


def test_the_picture(renders, tmp_path):
    captions = dict.fromkeys(renders.images, "mean ΔE00")
    draw(renders.images, captions, demo.LIGHTS, demo.SHOWN, LAYOUT, tmp_path / "charts.png")
    assert (tmp_path / "charts.png").read_bytes().startswith(b"\x89PNG")
