"""A reader of cube files, written from cube-file.md alone: numpy, and nothing of
uplift.

    python reader.py CUBE R G B [NM …]

prints the reflectances of linear RGB in [0, 1], as ``uplift query`` answers them.
"""

import hashlib
import json
import sys
from functools import cached_property
from pathlib import Path

import numpy as np

TYPES = {
    "F64": "<f8",
    "F32": "<f4",
    "U8": "|u1",
    "I32": "<i4",
    "I16": "<i2",
    "U32": "<u4",
}
GREY = (
    0,
    1e-10,
    1e-8,
    1e-6,
    1e-4,
)  # weights of grey, until the moments have a spectrum
LEAST, SLOPE, STEEP, MOST = (
    3e-4,
    0.03,
    100,
    0.01,
)  # distance from 0 and 1 of the mixtures that are moved
MAX_SIZE, EDGE = (
    500,
    1e-6,
)  # of multipliers that are mixed without their own colour; of entries from the edge
ALL_CORNERS = np.indices((2, 2, 2)).reshape(3, 8).T
FEATURES = {
    "debug",
    "errors",
    "left-out",
    "camera",
    "sparse",
    "outside",
    "outside-measured",
    "families",
}
TERMS = {
    "none": [],
    "vision": [(1, 0.0072, 538)],
    "colour": [(1, 0.0263, 480), (1.066, 0.0227, 578)],
}


class Cube:
    """The arrays of a file by their names, and what follows from them."""

    def __init__(self, path):
        data = Path(path).read_bytes()
        start = 8 + int.from_bytes(data[:8], "little")
        header = json.loads(data[8:start])
        self.meta = json.loads(header.pop("__metadata__")["uplift"])
        digest = self.meta.pop("digest")
        text = json.dumps(
            self.meta, sort_keys=True, ensure_ascii=False, separators=(",", ":")
        )
        found = hashlib.sha256(text.encode())
        self.arrays = {}
        for name in sorted(header):
            low, high = header[name]["data_offsets"]
            array = np.frombuffer(
                data[start + low : start + high], TYPES[header[name]["dtype"]]
            )
            self.arrays[name] = array = array.reshape(header[name]["shape"])
            found.update(
                f"{name} {array.dtype.str} {array.shape}".encode() + array.tobytes()
            )
        if (self.meta["format"], found.hexdigest()) != ("uplift cube", digest):
            raise ValueError("not a cube file, or damaged")
        if not set(self.meta["features"]) <= FEATURES:
            raise ValueError("a feature that this reader does not know")
        self.sigmoid = self.meta["model"]["name"] == "sigmoid"
        self.nodes = self.arrays["nodes"]
        self.threshold = self.meta["threshold"]
        self.entries = self.arrays.get(
            "atlas.entry_coefficients", self.arrays["atlas.coefficients"]
        )
        points = self.arrays.get("points", np.arange(len(self.nodes) ** 3))
        self.row = {int(number): row for row, number in enumerate(points)}
        # RGB of a reflectance is W g; K are the curves of the sensor without the light
        to_rgb = self.arrays["sensor.xyz_to_rgb"]
        power = self.arrays["sensor.power"]
        self.curves = self.arrays["sensor.cmfs"] @ to_rgb.T
        scale = power @ self.arrays["sensor.cmfs"][:, 1]
        if "sensor.sensitivities" in self.arrays:
            self.curves = self.arrays["sensor.sensitivities"] / (
                power @ self.arrays["sensor.sensitivities"]
            )
            scale = 1
        self.matrix = (self.curves * power[:, None] / scale).T
        self.luminance = np.linalg.inv(to_rgb)[1]

    def reflectance(self, rgb, wavelengths):
        """Reflectances at wavelengths in nm: a mixture, moved to its colour where nodes
        have not theirs.
        """
        rgb = np.asarray(rgb, float)
        sensor = self.arrays["sensor.wavelengths"]
        mixed, is_exact = self.mixture(rgb, np.asarray(wavelengths, float))
        at_sensor, _ = self.mixture(rgb, sensor)
        if is_exact or np.abs(self.matrix @ at_sensor - rgb).max() <= 1e-8:
            return mixed
        # g′ = S(x + K y) with W g′ = t, by Newton's steps, which are shortened where
        # they go too far
        goal = self.realisable(rgb)
        y = np.zeros(3)
        part = 1.0
        scale = np.linalg.inv(np.linalg.cholesky(self.matrix @ self.curves))
        off = np.abs(scale @ (goal - self.matrix @ at_sensor)).max()
        least = min(LEAST + SLOPE * off, STEEP * off, MOST)
        x = self.linear(at_sensor, least)
        off = goal - self.matrix @ self.squash(x)
        for _ in range(100):
            if np.abs(off).max() < 1e-12:
                break
            slope = self.squash(x + self.curves @ y, derivative=True)
            step = part * np.linalg.solve((self.matrix * slope) @ self.curves, off)
            after = goal - self.matrix @ self.squash(x + self.curves @ (y + step))
            part, good = (
                (min(4 * part, 1), True)
                if after @ step >= -off @ step / 2
                else (part / 4, False)
            )
            y, off = (y + step, after) if good else (y, off)
        curves = np.array(
            [np.interp(wavelengths, sensor, curve) for curve in self.curves.T]
        )
        return self.squash(self.linear(mixed, least) + y @ curves)

    def mixture(self, rgb, wavelengths):
        """Weighted reflectances of nodes and entry, and whether all nodes have their
        own colours.
        """
        entry, share, at = self.box(rgb)
        low = np.clip(
            np.searchsorted(self.nodes, at, side="right") - 1, 0, len(self.nodes) - 2
        )
        along = (at - self.nodes[low]) / (self.nodes[low + 1] - self.nodes[low])
        # along the axes in the order of decreasing fractions; red, green, blue if equal
        order = np.argsort(-along, kind="stable")
        corners = low + np.concatenate(
            [np.zeros((1, 3), int), np.eye(3, dtype=int)[order].cumsum(0)]
        )
        rows = [self.row[number] for number in self.numbers(corners)]
        weights = -np.diff(along[order], prepend=1, append=0)
        own = self.arrays["distance"] <= self.threshold
        limits = np.where(own[rows], np.inf, MAX_SIZE)
        value = weights @ self.spectra(
            self.arrays["coefficients"][rows].astype(float), wavelengths, limits
        )
        if entry is not None:
            value = (
                share * value
                + (1 - share) * self.spectra(self.entries[[entry]], wavelengths)[0]
            )
        cell = [self.row.get(number) for number in self.numbers(low + ALL_CORNERS)]
        return value, all(own[row] for row in cell if row is not None)

    def numbers(self, positions):
        """Numbers of the nodes at positions (n, 3)."""
        dim = len(self.nodes)
        return (positions @ [dim * dim, dim, 1]).tolist()

    def box(self, rgb):
        """The entry in whose box a colour lies, the weight of the lattice, and the
        colour at which it is evaluated.
        """
        steps = np.arange(len(self.nodes))
        for entry, (centre, reach) in enumerate(
            zip(self.arrays["atlas.rgb"], self.arrays["atlas.reach"], strict=True)
        ):
            at = np.interp(centre, self.nodes, steps)
            low, high = (
                np.interp(at + reach * sign, steps, self.nodes) for sign in (-1, 1)
            )
            low, high = (
                np.where(centre < EDGE, 2 * centre - high, low),
                np.where(centre > 1 - EDGE, 2 * centre - low, high),
            )
            if reach > 0 and (rgb >= low).all() and (rgb <= high).all():
                ray = rgb - centre
                room = np.where(ray > 0, high - centre, centre - low)
                share = np.divide(abs(ray), room, out=np.zeros(3), where=ray != 0).max()
                return (
                    entry,
                    share,
                    np.clip(centre + ray / share, 0, 1) if share > 0 else rgb,
                )
        return None, 1.0, rgb

    def spectra(self, coefficients, wavelengths, limits=np.inf):
        """Reflectances (n, N) of coefficients (n, C), with multipliers Σ |p| up to a
        limit.
        """
        model = self.meta["model"]
        first, last = (
            model.get(key, model.get("phase", {}).get(key)) for key in ("start", "end")
        )
        at = np.clip(wavelengths, first, last)
        if self.sigmoid:
            s = 2 * (at - first) / (last - first) - 1
            return self.squash(
                limited(coefficients, limits) @ [s * s, s, np.ones_like(s)]
            )
        low, at, high = (
            warp(model["phase"]["warp"], each) for each in (first, at, last)
        )
        phase = np.pi * (at - low) / (high - low) - np.pi
        basis = 2 * np.cos(np.outer(np.arange(coefficients.shape[1]), phase))
        basis[0] = 1
        return self.squash(limited(multipliers(coefficients), limits) @ basis)

    def squash(self, x, derivative=False):
        """S(x) or S′(x)."""
        if self.sigmoid:
            return (
                0.5 / (1 + x * x) ** 1.5
                if derivative
                else 0.5 + x / (2 * np.sqrt(1 + x * x))
            )
        return 1 / (np.pi * (1 + x * x)) if derivative else 0.5 + np.arctan(x) / np.pi

    def linear(self, reflectance, least):
        """S⁻¹ of reflectances, at least a distance away from 0 and 1."""
        half = np.clip(reflectance, least, 1 - least) - 0.5
        return (
            2 * half / np.sqrt(1 - 4 * half * half)
            if self.sigmoid
            else np.tan(np.pi * half)
        )

    @cached_property
    def solid(self):
        """The colours r of all reflectances, n · r ≤ d: unit normals n (F, 3) and
        distances d (F,) of the facets.
        """
        one, other = np.triu_indices(self.matrix.shape[1], 1)
        normals = np.cross(self.matrix.T[one], self.matrix.T[other])
        length = np.linalg.norm(normals, axis=1)
        normals = normals[length > 1e-15] / length[length > 1e-15, None]
        normals = np.concatenate([normals, -normals])
        return normals, np.maximum(normals @ self.matrix, 0).sum(axis=1)

    def realisable(self, rgb):
        """The colour, or the nearest one towards its grey that a reflectance has, half
        of the threshold inside.
        """
        margin, (normals, room) = self.threshold / 2, self.solid
        if (normals @ rgb - room).max() <= -2 * margin:
            return rgb
        grey = np.full(3, np.clip(self.luminance @ rgb, margin, 1 - margin))
        chroma = rgb - grey
        speed = normals @ chroma
        out = speed > 0
        reach = ((room - normals @ grey)[out] / speed[out]).min() - margin / max(
            margin, np.abs(chroma).max()
        )
        return grey + np.clip(reach, 0, 1) * chroma


def limited(found, limits):
    """Multipliers (n, C), scaled down to sums of magnitudes (n,)."""
    with np.errstate(divide="ignore"):
        return found * np.minimum(1, limits / np.abs(found).sum(axis=1))[:, None]


def multipliers(moments):
    """Multipliers (n, C) of moments (n, C)."""
    found = np.zeros_like(moments)
    pending = np.arange(len(moments))
    for weight in GREY:
        c = ((1 - weight) * moments[pending]).T
        c[0] += weight / 2
        count = len(c)
        turn = np.exp(1j * np.pi * c[0])
        tangent = np.tan(np.pi * c[0] / 2)
        with np.errstate(all="ignore"):
            series = [np.ones_like(turn)]  # exp(iX), X = π Σ c_l z^l
            for order in range(1, count):
                terms = ((order - k) * c[order - k] * series[k] for k in range(order))
                series.append(1j * np.pi / order * sum(terms))
            upper = np.imag(series)[1:]
            lower = np.imag(turn * np.array(series))[:-1]
            a, b = np.zeros((2, *c.shape))
            a[0], b[0], scale, valid = 1, 1, 1, (c[0] >= 0) & (c[0] <= 1)
            for order in range(count - 1):
                g = upper[0] / lower[0]
                upper, lower = upper[1:] - g * lower[1:], lower[:-1] - g * upper[:-1]
                a[1 : order + 2] += g * a[order::-1]
                b[1 : order + 2] -= g * b[order::-1]
                scale = scale * (1 - g * g)
                valid = valid & (g * g < 1)
            lags = [
                (
                    tangent * a[k:] * a[: count - k] - b[k:] * b[: count - k] / tangent
                ).sum(0)
                for k in range(count)
            ]
            p = np.array(lags).T / (2 * scale)[:, None]
        valid &= np.isfinite(p).all(axis=1)
        found[pending[valid]], pending = p[valid], pending[~valid]
    if pending.size:
        raise ValueError("moments of no reflectance")
    return found


def warp(name, wavelength):
    """The wavelength on the scale of the phase."""
    terms = [a * np.tanh(k * (wavelength - m)) for a, k, m in TERMS[name]]
    return sum(terms) if terms else wavelength


if __name__ == "__main__":
    cube = Cube(sys.argv[1])
    numbers = [float(word) for word in sys.argv[2:]]
    at = numbers[3:] or cube.arrays["sensor.wavelengths"]
    for wavelength, value in zip(at, cube.reflectance(numbers[:3], at), strict=True):
        print(f"{wavelength:g}\t{value:.12g}")
