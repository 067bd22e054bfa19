"""Recipes: their numbers decode as the decoder does."""

import re
import sys
from types import SimpleNamespace
from unittest.mock import MagicMock

import numpy as np
import pytest
from numpy.testing import assert_allclose

from uplift.extras.scene.passes.decoder import decoder as make_decoder
from uplift.extras.scene.passes.recipe import RECIPES

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
