"""Recipes: their numbers decode as the decoder does."""

import re
import sys
from types import SimpleNamespace

import numpy as np
import OpenEXR
import pytest
from numpy.testing import assert_allclose

from tests.helpers import run_python
from tests.parts import BLENDER, need
from uplift.extras.scene import passes as library

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
    return library.decoder(two_passes, space="ACEScg")


def test_text(decoder):
    text = library.plain_recipe(decoder)
    found = re.findall(r"[RGB] = (\S+) R (\S+) G (\S+) B", text)
    matrices = np.array(found, dtype=float).reshape(2, 3, 3)
    decoded = matrices[0] @ NUMBERS[:3] + matrices[1] @ NUMBERS[3:]
    assert_allclose(decoded, decoder.matrix @ NUMBERS, atol=1e-6)


def test_nuke(decoder):
    text = library.nuke_recipe(decoder)
    rows = re.findall(r"\{(-?[\d.]+) (-?[\d.]+) (-?[\d.]+)\}", text)
    matrices = np.array(rows, dtype=float).reshape(2, 3, 3)
    assert_allclose(np.concatenate(matrices, axis=1), decoder.matrix, atol=1e-6)
    assert text.count("Merge2") == 1
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

    def __init__(self, kind, enter):
        self.kind = kind
        self.operation = ""
        self.inputs = [Socket() for _ in range(4)]
        if kind == "NodeGroupInput":
            self.outputs = [Socket(lambda rgb=rgb: rgb) for rgb in enter]
        elif kind == "CompositorNodeSeparateColor":
            self.outputs = [
                Socket(lambda channel=channel: self.inputs[0].value()[channel])
                for channel in range(3)
            ]
        elif kind == "CompositorNodeCombineColor":
            self.outputs = [
                Socket(lambda: [socket.value() for socket in self.inputs[:3]])
            ]
        else:
            self.outputs = [Socket(self.multiply_add)]

    def multiply_add(self):
        assert self.operation == "MULTIPLY_ADD"
        first, second, third = (socket.value() for socket in self.inputs[:3])
        return first * second + third


@pytest.mark.parametrize("own_math", [True, False])
def test_blender(decoder, monkeypatch, own_math):
    """The script makes nodes that compute the picture."""
    nodes = []
    links = []

    def new_node(kind):
        nodes.append(Node(kind, (NUMBERS[:3], NUMBERS[3:])))
        return nodes[-1]

    def new_link(source, target):
        links.append((source, target))
        target.source = source

    sockets = []
    tree = SimpleNamespace(
        nodes=SimpleNamespace(new=new_node),
        links=SimpleNamespace(new=new_link),
        interface=SimpleNamespace(
            new_socket=lambda name, **kind: sockets.append((name, kind["in_out"]))
        ),
    )
    types = SimpleNamespace(**({"CompositorNodeMath": Node} if own_math else {}))
    groups = SimpleNamespace(new=lambda name, kind: tree)
    bpy = SimpleNamespace(data=SimpleNamespace(node_groups=groups), types=types)
    monkeypatch.setitem(sys.modules, "bpy", bpy)
    exec(library.blender_recipe(decoder), {})
    leave = next(node for node in nodes if node.kind == "NodeGroupOutput")
    assert_allclose(leave.inputs[0].value(), decoder.matrix @ NUMBERS, atol=1e-6)
    kinds = {node.kind for node in nodes if "Math" in node.kind}
    assert kinds == {"CompositorNodeMath" if own_math else "ShaderNodeMath"}
    assert [kind for _, kind in sockets] == ["INPUT", "INPUT", "OUTPUT"]


def test_blender_itself(decoder, tmp_path):
    """The node group in Blender, where it is installed, decodes pictures."""
    need(BLENDER)
    values = np.random.default_rng(0).random((6, 8, 6)).astype(np.float32)
    for number in (1, 2):
        planes = np.moveaxis(values[..., 3 * number - 3 : 3 * number], -1, 0)
        channels = {
            name: np.ascontiguousarray(plane)
            for name, plane in zip("RGB", planes, strict=True)
        }
        OpenEXR.File({}, channels).write(str(tmp_path / f"a.{number}.exr"))
    script = tmp_path / "decode.py"
    script.write_text(library.blender_recipe(decoder), encoding="utf-8")
    run_python(COMPOSE, script, tmp_path, 8, 6)
    file = OpenEXR.File(str(tmp_path / "decoded.exr"), separate_channels=True)
    found = {name[-1]: channel.pixels for name, channel in file.channels().items()}
    decoded = np.stack([found[name] for name in "RGB"], axis=-1)
    assert_allclose(decoded, values @ decoder.matrix.T, atol=1e-5)
