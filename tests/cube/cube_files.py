"""Forged cube files with valid digests."""

import hashlib
import json
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from safetensors.numpy import save_file

from uplift.cube import container
from uplift.cube.data import CubeData
from uplift.cube.file import contents


def forge(
    data: CubeData, path: Path, change: Callable[[dict[str, Any], dict[str, Any]], None]
) -> Path:
    """Write ``data`` after ``change(tensors, metadata)``, with the digest of the
    changed content.
    """
    tensors, metadata = contents(data)
    metadata = json.loads(json.dumps(metadata))
    change(tensors, metadata)
    tensors = {name: np.ascontiguousarray(array) for name, array in tensors.items()}
    metadata["digest"] = forged_digest(tensors, metadata)
    save_file(tensors, path, metadata={container.KEY: forged_json(metadata)})
    return path


def forged_digest(tensors: dict[str, Any], metadata: dict[str, Any]) -> str:
    """Digest of docs/cube-file.md, also of values that cube files may not have."""
    content = hashlib.sha256(forged_json(metadata).encode())
    for name, array in sorted(tensors.items()):
        content.update(f"{name} {array.dtype.str} {array.shape}".encode())
        content.update(array.tobytes())
    return content.hexdigest()


def forged_json(metadata: dict[str, Any]) -> str:
    """JSON text as in cube files, but with NaN and infinity."""
    return json.dumps(
        metadata, sort_keys=True, ensure_ascii=False, separators=(",", ":")
    )


def header_length(content: bytes) -> int:
    """Length of the JSON header of a safetensors file."""
    return int(struct.unpack("<Q", content[:8])[0])


def with_header_length(content: bytes, length: int) -> bytes:
    """The file with another length of its header."""
    return struct.pack("<Q", length) + content[8:]


def with_header(content: bytes, header: bytes) -> bytes:
    """The arrays with another header."""
    return (
        struct.pack("<Q", len(header)) + header + content[8 + header_length(content) :]
    )
