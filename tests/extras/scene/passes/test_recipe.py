"""Recipes: their numbers decode as the decoder does."""

import re
import sys
from types import SimpleNamespace
from unittest.mock import MagicMock

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.extras.texture.conftest import channels, planes, write_exr
from tests.helpers import run_python
from tests.parts import BLENDER, need
from uplift.extras.scene.passes.decoder import decoder as make_decoder
from uplift.extras.scene.passes.recipe import RECIPES

COMPOSE = """
import sys
from pathlib import Path

import bpy

script, folder, width, height = sys.argv[1:]
names = {}
exec(Path(script).read_text(encoding="utf-8"), names)
scene = bpy.context.scene
tree = bpy.data.node_groups.new("compositor", "CompositorNodeTree")
scene.compositing_node_group = tree
tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
leave = tree.nodes.new("NodeGroupOutput")
group = tree.nodes.new("CompositorNodeGroup")
group.node_tree = names["GROUP"]
for number in (1, 2):
    image = bpy.data.images.load(f"{folder}/a.{number}.exr")
    image.colorspace_settings.name = "Non-Color"
    node = tree.nodes.new("CompositorNodeImage")
    node.image = image
    tree.links.new(node.outputs[0], group.inputs[number - 1])
tree.links.new(group.outputs[0], leave.inputs[0])
for thing in [each for each in bpy.data.objects if each.type == "MESH"]:
    bpy.data.objects.remove(thing)
render = scene.render
render.engine = "CYCLES"
scene.cycles.samples = 1
render.resolution_x = int(width)
render.resolution_y = int(height)
render.resolution_percentage = 100
render.use_compositing = True
render.image_settings.file_format = "OPEN_EXR"
render.image_settings.color_depth = "32"
render.filepath = f"{folder}/decoded.exr"
bpy.ops.render.render(write_still=True)
"""
"""Program that composes two pictures in Blender."""
NUMBERS = np.array([0.3, 0.5, 0.2, 0.9, 0.4, 0.7])


@pytest.fixture
def decoder(two_passes):
    """A decoder to ACEScg."""
    return make_decoder(two_passes, space="ACEScg")


@pytest.mark.parametrize(
    ("tool", "row"),
    [
        ("text", r"[RGB] = (\S+) R (\S+) G (\S+) B"),
        ("nuke", r"\{(-?[\d.]+) (-?[\d.]+) (-?[\d.]+)\}"),
    ],
)
def test_texts_have_the_matrices(decoder, tool, row):
    text = RECIPES[tool](decoder)
    matrices = np.array(re.findall(row, text), dtype=float).reshape(2, 3, 3)
    assert_allclose(np.concatenate(matrices, axis=1), decoder.matrix, atol=1e-6)
    assert text.count("Merge2") == (tool == "nuke")
    assert text.count("{") == text.count("}")


class Socket:
    """A socket of a node: a value, or the output that is linked to it."""

    def __init__(self, compute=None):
        self.default_value = 0.0
        self.source = None
        self.compute = compute

    def value(self):
        if self.compute is not None:
            return self.compute()
        return self.default_value if self.source is None else self.source.value()


class Node:
    """A node of the compositor, as far as the script uses it."""

    def __init__(self, kind):
        self.kind = kind
        self.inputs = [Socket() for _ in range(4)]
        if kind == "NodeGroupInput":
            self.outputs = [Socket(lambda: NUMBERS[:3]), Socket(lambda: NUMBERS[3:])]
        elif kind == "CompositorNodeSeparateColor":
            self.outputs = [
                Socket(lambda channel=channel: self.values()[0][channel])
                for channel in range(3)
            ]
        elif kind == "CompositorNodeCombineColor":
            self.outputs = [Socket(lambda: self.values()[:3])]
        else:
            self.outputs = [Socket(self.multiply_add)]

    def values(self):
        return [socket.value() for socket in self.inputs]

    def multiply_add(self):
        assert self.operation == "MULTIPLY_ADD"
        first, second, third, _ = self.values()
        return first * second + third


@pytest.mark.parametrize("own_math", [True, False])
def test_blender(decoder, monkeypatch, own_math):
    """The script makes nodes that compute the picture."""
    nodes = {}

    def new_node(kind):
        node = Node(kind)
        nodes.setdefault(kind, []).append(node)
        return node

    tree = MagicMock()
    tree.nodes.new = new_node
    tree.links.new = lambda source, target: setattr(target, "source", source)
    bpy = SimpleNamespace(data=MagicMock(), types=SimpleNamespace())
    bpy.data.node_groups.new.return_value = tree
    if own_math:
        bpy.types.CompositorNodeMath = Node
    monkeypatch.setitem(sys.modules, "bpy", bpy)
    exec(RECIPES["blender"](decoder), {})
    (leave,) = nodes["NodeGroupOutput"]
    assert_allclose(leave.values()[0], decoder.matrix @ NUMBERS, atol=1e-6)
    assert ("CompositorNodeMath" if own_math else "ShaderNodeMath") in nodes


def test_blender_itself(decoder, tmp_path):
    """The node group in Blender, where it is installed, decodes pictures."""
    need(BLENDER)
    values = np.random.default_rng(0).random((6, 8, 6)).astype(np.float32)
    write_exr(tmp_path / "a.1.exr", planes(values[..., :3]))
    write_exr(tmp_path / "a.2.exr", planes(values[..., 3:]))
    script = tmp_path / "decode.py"
    script.write_text(RECIPES["blender"](decoder), encoding="utf-8")
    run_python(COMPOSE, script, tmp_path, 8, 6)
    found = {
        name[-1]: plane for name, plane in channels(tmp_path / "decoded.exr").items()
    }
    decoded = np.stack([found[name] for name in "RGB"], axis=-1)
    assert_allclose(decoded, values @ decoder.matrix.T, atol=1e-5)
