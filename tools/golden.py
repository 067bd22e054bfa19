"""The golden set: what commands answer and write, before a change and after it, bit by bit.

    python -m tools.golden record          # out/golden/before, from the code as it is
    python -m tools.golden [NAME ...]      # run again into out/golden/now, and compare

A NAME chooses the lines whose name contains it. Prints what differs; exits with 1 if anything does.
"""

import contextlib
import difflib
import io
import os
import re
import shlex
import shutil
import sys
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "out" / "golden"
CUBES = sorted((ROOT / "cubes").glob("*.uplift"))
MODES = ("spectra", "moments", "refined", "nearest")

# name of the line: the command, whose files are written into a folder of that name
LINES = {
    "samples": "samples .",
    "macbeth": "build --atlas macbeth --dim 16 --debug -o macbeth.uplift",
    "sigmoid": "build --atlas macbeth --dim 8 --model sigmoid -o sigmoid.uplift",
    "acescg": "build --space ACEScg --illuminant D60 --dim 8 -o acescg.uplift",
    "p3": "build --atlas paints.csv --space P3-D65 --dim 8 -o p3.uplift",
    "smooth": "build --prior smooth --dim 8 -o smooth.uplift",
    "library": "build --library fabrics.csv --dim 8 -o library.uplift",
    "looks": "build --atlas macbeth --look looks.toml --dim 8 -o looks.uplift",
    "scene": "build --atlas macbeth --dim 32 --scene wood.png -o scene.uplift",
    "auto": "build --atlas paints.csv --dim auto -o auto.uplift",
    "camera": "build --atlas macbeth --observer 'Nikon 5100 (NPL)' --space camera --dim 8 -o camera.uplift",
    "neighbours": "build --atlas macbeth --start neighbours --dim 4 -o neighbours.uplift",
    "lights-build": "lights build -o lights.uplift",
    **{f"check-{cube.stem}": f"check {cube} --format json" for cube in CUBES},
    **{f"query-{mode}": f"query --mode {mode} --input colours.csv --format csv" for mode in MODES},
    **{
        f"query-{mode}-{name}": f"query --cube ../{name}/{name}.uplift --mode {mode} 0.18 0.3 0.1 --format json"
        for mode in MODES
        for name in ("macbeth", "acescg", "p3", "sigmoid")
    },
    "query-json": "query 0.8 0.2 0.1 --wavelengths 400:700:10 --format json",
    "query-text": "query '#da7b2a' --plot orange.png",
    "query-light": "bounds '#8a2a20' --light A --light FL11 --html looks.html",
    "query-out-of-gamut": "query --input-space P3-D65 0.2 0.9 0.3 --out-of-gamut desaturate --format json",
    "query-xyz": "query --xyz 0.05 0.2 0.1",
    "query-looks": "query '#8a2a20' --cube ../looks/looks.uplift --light HP1",
    "bounds": "bounds '#8a2a20' --light A --light FL11 --plot regions.png --format json",
    "bounds-text": "bounds '#8a2a20' --light A --light FL11",
    "lights-query": "lights query 30 22 9 --wavelengths 400:700:10 --format json",
    "lights-text": "lights query 30000 21000 9000",
    "texture-spectra": "texture wood.png -o wood.exr",
    "texture-float": "texture painting.exr -o wood.exr --depth float --cube ../macbeth/macbeth.uplift",
    "texture-moments": "texture wood.png -o moments.exr --representation moments",
    "texture-multipliers": "texture wood.png -o multipliers.exr --representation multipliers",
    "texture-looks": "texture wood.png -o o.exr --mask mask.png"
    " --cube ../auto/auto.uplift --cube ../looks/looks.uplift",
    "texture-space": "texture painting.exr -o aces.exr --cube ../acescg/acescg.uplift --input-space ACEScg",
    "texture-sequence": "texture 'shot.*.exr' -o uplifted --representation moments",
    "texture-lights": "lights texture sky.exr -o lit.exr --wavelengths 400:700:20",
    "export-h": "export ../macbeth/macbeth.uplift -o cube.h",
    "export-cuh": "export ../macbeth/macbeth.uplift -o cube.cuh",
    "export-glsl": "export ../macbeth/macbeth.uplift -o cube.glsl",
    "export-hlsl": "export ../macbeth/macbeth.uplift -o cube.hlsl",
    "export-html": "export ../macbeth/macbeth.uplift -o cube.html",
    "export-npz": "export ../macbeth/macbeth.uplift -o cube.npz",
    "export-csv": "export ../macbeth/macbeth.uplift -o cube.csv",
    "export-coeff": "export ../macbeth/macbeth.uplift -o srgb.coeff",
    "lights-export-h": "lights export -o lights.h",
    "lights-export-glsl": "lights export -o lights.glsl",
    "slices": "slices ../macbeth/macbeth.uplift -o macbeth.exr --plot macbeth.png",
    "lights-slices": "lights info --plot emission.png",
    "info": "info ../macbeth/macbeth.uplift --format json",
    "info-text": "info ../looks/looks.uplift",
    "lights-info": "lights info",
    "report-json": "report ../macbeth/macbeth.uplift --format json",
    "report-html": "report ../macbeth/macbeth.uplift --atlas cie2017 -o unseen.html",
    "lights-report": "lights info --html emission.html",
    "atlas-list": "atlas",
    "atlas-macbeth": "atlas macbeth -o macbeth.csv",
    "atlas-paints": "atlas paints.csv --format json -o paints.txt",
    "relight": "relight wood.png -o wood.html",
    "mix-pigment": "mix --pigment 2:'#005fa0' 1:'#ffd200'",
    "mix-dye": "mix --dye 1:'#d03060' 3:'#f0c000' --refractive-index 1.5 --thickness 2 --format json",
    "mix-filter": "mix --filter 2:'#ff8000' 1:0.5,0.5,0.5 --format json",
    "mix-light": "mix --additive '#ff0000' 0.5:'#00ff00' --format json",
    "mix-theories": "mix --theories '#005fa0' '#ffd200'",
    "mix-over": "mix '#c8342a' --thickness 0.4 --over painting.exr -o painted.exr",
    "mix-ground": "mix '#c8342a' --thickness 0.5 --ground '#f0e8d8' --format json",
    "wavelengths": "wavelengths --count 8 --format json",
    "wavelengths-text": "wavelengths --tolerance 1 --light D65 --light FL11 --plot wavelengths.png",
    "compare": "compare --quick --format json",
    "palette": "palette metamers.toml --plot matrix.png --plot-spectra spectra.png -o designed.txt",
    "palette-html": "palette engine.toml --html engine.html",
    "palette-constant": "palette constant.toml --format json",
    "plan": "plan kitchen.toml --format json",
}


def run(folder: Path, names: list[str]) -> None:
    """Run the lines called `names`, each in a folder of its name next to copies of the samples."""
    from uplift_cli.main import main

    for name in names:
        began = time.perf_counter()
        place = folder / name
        shutil.rmtree(place, ignore_errors=True)
        if name == "samples":
            place.mkdir(parents=True)
        else:
            shutil.copytree(folder / "samples", place)
        out, err = io.StringIO(), io.StringIO()
        code: object = 0
        with contextlib.chdir(place), contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            try:
                main(shlex.split(LINES[name]), standalone_mode=True)
            except SystemExit as stop:
                code = stop.code
        (place / "stdout.txt").write_text(out.getvalue())
        (place / "code.txt").write_text(f"{code}\n{err.getvalue() if code else ''}")
        if name != "samples":  # keep what the line wrote
            for sample in (folder / "samples").rglob("*"):
                twin = place / sample.relative_to(folder / "samples")
                kept = twin.name in ("stdout.txt", "code.txt")
                if not kept and twin.is_file() and twin.read_bytes() == sample.read_bytes():
                    twin.unlink()
        print(f"{time.perf_counter() - began:6.1f} s  {name}  {code}", file=sys.stderr, flush=True)


def normalised(path: Path) -> bytes:
    """The bytes of a file, its durations as 0."""
    data = path.read_bytes()
    if path.suffix in (".txt", ".json"):
        data = re.sub(rb"\b[0-9.]+ s\b", b"0 s", data)
        data = re.sub(rb'("(?:cpu_seconds|ns|ns_least|ns_most)": )[0-9.e-]+', rb"\g<1>0", data)
    return data


def differences(before: Path, now: Path) -> list[str]:
    """What differs between two folders of one line."""
    names = {path.relative_to(top) for top in (before, now) for path in top.rglob("*") if path.is_file()}
    found = []
    for name in sorted(names):
        old, new = before / name, now / name
        if not old.exists() or not new.exists():
            found.append(f"{name}: only {'now' if new.exists() else 'before'}")
        elif normalised(old) != normalised(new) and (text := difference(old, new)):
            found.append(f"{name}: {text}")
    return found


def difference(old: Path, new: Path) -> str:
    """How two files differ: by how much for numbers, the first lines for text."""
    if old.suffix == ".exr":
        return exr_difference(old, new)
    try:
        lines = (normalised(old).decode().splitlines(), normalised(new).decode().splitlines())
    except UnicodeDecodeError:
        return f"{old.stat().st_size} and {new.stat().st_size} bytes"
    compared = difflib.unified_diff(*lines, lineterm="", n=0)
    changed = [line for line in compared if not line.startswith(("---", "+++", "@@"))]
    return f"{len(changed)} lines\n" + "\n".join("      " + line[:160] for line in changed[:8])


def exr_difference(old: Path, new: Path) -> str:
    """By how much the pixels of two images differ, and which attributes do; empty for none."""
    import OpenEXR

    texts = []
    for part, (a, b) in enumerate(zip(OpenEXR.File(str(old)).parts, OpenEXR.File(str(new)).parts, strict=False)):
        shapes = [{name: channel.pixels.shape for name, channel in each.channels.items()} for each in (a, b)]
        if shapes[0] != shapes[1]:
            texts.append(f"part {part} has other channels")
            continue
        pixels = [np.concatenate([each.channels[name].pixels.ravel() for name in shapes[0]]) for each in (a, b)]
        worst = np.max(np.abs(np.subtract(*pixels, dtype=float)))
        keys = {*a.header, *b.header} - {"capDate", "uplift.checksum"}
        headers = [key for key in sorted(keys) if str(a.header.get(key)) != str(b.header.get(key))]
        if worst or headers:
            texts.append(f"part {part}: pixels by {worst:.2g}, header {', '.join(headers) or 'same'}")
    return "; ".join(texts)


def chosen(words: list[str]) -> list[str]:
    """The lines whose names contain one of `words`, and those whose files they read."""
    names = [name for name in LINES if not words or any(word in name for word in words)]
    read = [name for name in LINES if any(f"../{name}/" in LINES[each] for each in names)]
    return [name for name in LINES if name in {"samples", *names, *read}]


def main(arguments: list[str]) -> int:
    recording = arguments[:1] == ["record"]
    names = chosen(arguments[recording:])
    os.environ.setdefault("XDG_CACHE_HOME", str(ROOT / "out" / "cache" / "golden"))
    os.environ["COLUMNS"] = "100"
    folder = FOLDER / ("before" if recording else "now")
    run(folder, names)
    if recording:
        return 0
    failed = 0
    for name in names:
        if found := differences(FOLDER / "before" / name, folder / name):
            failed += 1
            print(f"{name}:", *found, sep="\n    ")
    print(f"{len(names)} lines, {failed} differ")
    return bool(failed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
