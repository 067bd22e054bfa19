"""Recipes: their numbers decode as the decoder does."""

import re
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from uplift.extras.scene import passes as library

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
