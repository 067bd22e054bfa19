"""A complete plan, and its errors by an independent computation."""

import json
import shutil
from dataclasses import asdict, replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.extras.scene.plan.conftest import LIGHTS, SMALL, painted
from tests.extras.texture.conftest import planes, write_exr
from tests.helpers import raises
from uplift import models
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.common.errors import PlanFileError
from uplift.extras.scene import plan
from uplift.extras.scene.plan.files import read_plan
from uplift.extras.scene.plan.planning import no_candidate
from uplift.extras.scene.plan.summary import notes, to_json
from uplift.extras.texture.scene_colours import Images


@pytest.mark.filterwarnings("ignore::uplift.UpliftWarning")
def test_an_independent_computation_on_every_pixel_agrees(planned, kitchen):
    found, _ = planned
    chosen = found.chosen
    assert found.within_tolerance
    assert chosen in found.front
    rgb = painted().reshape(-1, 3).astype(float)
    atlas = kitchen.parent / "macbeth.txt"
    scene = Images((kitchen.parent / "wood.exr",))
    best = uplift.build(
        atlas, scene=scene, dim=SMALL.reference, coefficients=9, lights=LIGHTS
    )
    cube = uplift.build(atlas, scene=scene, **asdict(chosen.cube))
    sampling = chosen.rendering.sampling
    spectra = cube.reflectance(rgb, sampling.wavelengths)
    if chosen.pixel.form == "moments":
        kind = np.float16 if chosen.pixel.depth == "half" else np.float32
        stored = cube.coefficients(rgb).astype(kind).astype(float)
        spectra = models.reflectance(cube.data.model, stored, sampling.wavelengths)
    for name in LIGHTS:
        light = observer.light(name)
        power = sampling.powers[sampling.lights.index(name)]
        delta_e = delta_e_2000(
            lab(spectra * power @ sampling.to_xyz, light.white),
            lab(best.reflectance(rgb) @ light.xyz.T, light.white),
        )
        low, high = np.quantile(delta_e, (0.95, 0.99))
        for error in (chosen.error, found.confirmed):
            [part] = [
                each
                for each in error.parts
                if (each.group, each.light) == ("textures", name)
            ]
            # Quantiles of a sample of pixels vary.
            assert 0.9 * low < part.quantile < 1.1 * high
            assert delta_e.mean() == pytest.approx(part.mean, rel=0.2)


def test_without_a_candidate_the_error_names_what_is_missing(planned):
    found, _ = planned
    error = no_candidate(replace(found.scene, tolerance=0.02), found.measured)
    feasible = error.hint.removeprefix("set tolerance = ").removesuffix(" or more")
    assert float(feasible) >= min(each.error.quantile for each in found.measured)
    limits = {"samples": 2, "memory": 1e9}
    error = no_candidate(replace(found.scene, limits=limits), found.measured)
    assert (error.code, error.path) == ("no-candidate", found.scene.path)
    assert (
        error.problem
        == "no candidate: the cheapest within 3 needs 5 samples; limits allow 2 samples"
    )


def planned_for(tmp_path, rgb, lights=LIGHTS, **values):
    path = write_exr(tmp_path / "a.exr", planes(np.asarray(rgb, np.float32)))
    scene = plan.SceneFile(tmp_path / "a.toml", (path,), lights=lights, **values)
    return plan.plan(scene, SMALL)


def test_a_scene_under_the_light_of_its_space_needs_no_spectra(tmp_path):
    found = planned_for(tmp_path, painted(), ("D65",))
    assert found.chosen.rendering is None
    assert found.confirmed.quantile < 1e-3
    assert "no spectra" in " ".join(notes(found))
    path = tmp_path / "a.plan.json"
    values = to_json(found, path)
    matrix = np.array(values["rendering"]["rgb_to_xyz"]["D65"])
    assert_allclose(matrix, found.scene.sensor().rgb_to_xyz, atol=1e-6)
    path.write_text(json.dumps(values), encoding="utf-8")
    with raises(PlanFileError) as caught:
        read_plan(path)
    assert "needs no cube" in caught.value.problem


def test_a_list_of_spectra_is_written(tmp_path):
    paints = [[0.6, 0.1, 0.05], [0.05, 0.3, 0.6], [0, 0, 0]]
    found = planned_for(tmp_path, [paints] * 500, ("D65", "A", "FL11"), tolerance=1.0)
    assert found.chosen.pixel.form == "index"
    values = to_json(found, tmp_path / "a.plan.json")
    spectra = np.array([each["reflectance"] for each in values["spectra"]])
    rgb = np.array([each["rgb"] for each in values["spectra"]])
    assert len(rgb) == 3
    rendering = values["rendering"]
    xyz = spectra * np.array(rendering["powers"]["D65"]) @ np.array(rendering["to_xyz"])
    assert_allclose(xyz, rgb @ found.scene.sensor().rgb_to_xyz.T, atol=0.02)


@pytest.fixture
def plan_file(planned, kitchen, tmp_path):
    """Path of a plan file in a copy of the scene's folder, its values, and a function
    that writes them.
    """
    path = tmp_path / "copy" / "kitchen.plan.json"
    shutil.copytree(kitchen.parent, path.parent)
    values = to_json(planned[0], kitchen.parent / path.name)
    return path, values, lambda: path.write_text(json.dumps(values), encoding="utf-8")


@pytest.mark.filterwarnings("ignore::uplift.UpliftWarning")
def test_the_plan_file_builds_the_cube_whose_cost_was_estimated(planned, plan_file):
    path, _, write = plan_file
    write()
    cube = read_plan(path).build()
    chosen = planned[0].chosen
    assert cube.data.lattice.dim == chosen.cube.dim
    assert cube.data.model.count == chosen.cube.coefficients
    assert cube.data.is_sparse == chosen.sparse
    stored = path.with_suffix(".uplift")
    cube.save(stored)
    pixels = 20 * 20 * chosen.pixel.size(0, int(chosen.cost.samples))
    expected = stored.stat().st_size + pixels
    assert chosen.cost.memory == pytest.approx(expected, rel=0.25)


def test_changed_and_missing_sources_are_refused(plan_file):
    path, _, write = plan_file
    write()
    image = path.parent / "wood.exr"
    assert read_plan(path).images.paths == (image,)
    (path.parent / "macbeth.txt").write_text("changed", encoding="utf-8")
    with raises(PlanFileError, "source-changed") as caught:
        read_plan(path)
    assert "scene.atlases[0].path: 'macbeth.txt'" in caught.value.problem
    image.unlink()
    with raises(PlanFileError, "file-not-found") as caught:
        read_plan(path)
    assert "scene.textures[0].path" in caught.value.problem


@pytest.mark.parametrize(
    ("section", "change", "code", "start"),
    [
        (None, {"build": None}, "invalid-file", "build"),
        (None, {"format": "uplift plan 2"}, "invalid-file", "format"),
        ("build", {"dims": 3}, "unknown-name", "build: unknown option 'dims'"),
        ("build", {"dim": "x"}, "option", "build: dim "),
        ("build", {"observer": "/etc/a.csv"}, "unknown-name", "build: unknown"),
        ("scene", {"textures": [3]}, "invalid-file", "scene.textures[0]"),
        (
            "scene",
            {"textures": [{"path": "wood.exr"}]},
            "invalid-file",
            "scene.textures[0].digest",
        ),
        (
            "scene",
            {"atlases": [{"path": "../a.txt", "digest": "0"}]},
            "invalid-file",
            "scene.atlases[0].path must lie in the folder",
        ),
    ],
)
def test_an_invalid_plan_is_refused_with_its_key(
    plan_file, section, change, code, start
):
    path, values, write = plan_file
    part = values[section] if section else values
    part.update(change)
    write()
    with raises(PlanFileError, code) as caught:
        read_plan(path)
    assert caught.value.problem.startswith(start)
    assert caught.value.hint
