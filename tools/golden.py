"""The golden set: what the commands of tools/golden.txt answer and write, before a change and after it, bit by bit.

    python -m tools.golden record          # out/golden/before, from the code as it is
    python -m tools.golden [NAME ...]      # run again into out/golden/now, and compare

A NAME chooses the lines whose name contains it. Prints what differs; exits with 1 if anything does.
"""

import contextlib
import difflib
import hashlib
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
LINES = dict(line.split(": ", 1) for line in (ROOT / "tools" / "golden.txt").read_text().splitlines())
"""Commands by name. Each runs next to copies of the samples, in a folder of its name."""


def run(name: str, folder: Path) -> None:
    """Run a line in ``folder``, and keep the files that it wrote there."""
    from uplift_cli.main import main

    shutil.rmtree(folder, ignore_errors=True)
    samples = folder.parent / "samples"
    folder.mkdir(parents=True) if name == "samples" else shutil.copytree(samples, folder)
    out, err = io.StringIO(), io.StringIO()
    code: object = 0
    with contextlib.chdir(folder), contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            main(shlex.split(LINES[name].replace("{root}", str(ROOT))), standalone_mode=True)
        except SystemExit as stop:
            code = stop.code
    for sample in samples.rglob("*") if name != "samples" else ():
        copy = folder / sample.relative_to(samples)
        if copy.is_file() and copy.read_bytes() == sample.read_bytes():
            copy.unlink()
    (folder / "stdout.txt").write_text(out.getvalue())
    (folder / "code.txt").write_text(f"{code}\n{err.getvalue() if code else ''}")


def content(path: Path) -> bytes:
    """The bytes of a file without durations and folders, the attributes and pixels of an image without its date."""
    if not path.exists():
        return b"no such file"
    data = path.read_bytes()
    if path.suffix in (".txt", ".json", ".html"):
        data = re.sub(rb"\b[0-9.]+ s\b", b"0 s", data)
        data = re.sub(rb'"/[^"]*/cubes/', b'"cubes/', data)
        return re.sub(rb'("(?:cpu_seconds|ns|ns_least|ns_most)": )[0-9.e-]+', rb"\g<1>0", data)
    if path.suffix == ".exr":
        import OpenEXR

        lines = []
        for part in OpenEXR.File(str(path)).parts:
            lines += [f"{k}: {v}" for k, v in sorted(part.header.items()) if k not in ("capDate", "uplift.checksum")]
            for name, pixels in ((name, channel.pixels) for name, channel in part.channels.items()):
                digest = hashlib.sha256(pixels.tobytes()).hexdigest()
                lines.append(f"{name} {pixels.shape}: mean {np.mean(pixels, dtype=float):.9g}, {digest}")
        return "\n".join(lines).encode()
    return data


def difference(old: bytes, new: bytes) -> str:
    """The first lines that differ."""
    lines = (each.decode(errors="replace").splitlines() for each in (old, new))
    compared = list(difflib.unified_diff(*lines, lineterm="", n=0))[2:]
    changed = ["      " + line[:160] for line in compared if not line.startswith("@@")]
    return "\n".join([f"{len(changed)} lines", *changed[:8]])


def main(arguments: list[str]) -> int:
    recording = arguments[:1] == ["record"]
    words = arguments[recording:]
    names = {name for name in LINES if not words or any(word in name for word in words)}
    names |= {"samples"} | {name for name in LINES if any(f"../{name}/" in LINES[each] for each in names)}
    os.environ.setdefault("XDG_CACHE_HOME", str(ROOT / "out" / "cache" / "golden"))
    os.environ["COLUMNS"] = "100"
    before, now = FOLDER / "before", FOLDER / ("before" if recording else "now")
    failed = 0
    for name in (name for name in LINES if name in names):
        began = time.perf_counter()
        run(name, now / name)
        print(f"{time.perf_counter() - began:6.1f} s  {name}", file=sys.stderr, flush=True)
        tops = before / name, now / name
        files = sorted({path.relative_to(top) for top in tops for path in top.rglob("*") if path.is_file()})
        pairs = {file: [content(top / file) for top in tops] for file in files}
        found = [f"{file}: {difference(*pair)}" for file, pair in pairs.items() if pair[0] != pair[1]]
        if found:
            failed += 1
            print(f"{name}:", *found, sep="\n    ")
    print(f"{len(names)} lines, {failed} differ")
    return bool(failed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
