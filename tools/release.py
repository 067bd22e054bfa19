"""Check the distributions of a release: contents, size, and what they do when they are
installed with the newest and with the oldest dependencies that they allow.

``make release`` builds them from the last commit and runs ``python -m tools.release
FOLDER``.
"""

import subprocess
import sys
import tarfile
import tempfile
import zipfile
from collections.abc import Iterable
from pathlib import Path, PurePosixPath

ROOT = Path(__file__).parents[1]
FOLDERS = {"uplift": "uplift", "cli": "uplift_cli", "atlases": "uplift_atlases"}
"""Folders of the source and their packages."""
WHEEL_INFO = {
    "METADATA",
    "RECORD",
    "WHEEL",
    "entry_points.txt",
    "licenses/LICENSE",
    "top_level.txt",
}
SOURCE_FILES = {"CHANGELOG.md", "CITATION.cff", "LICENSE", "README.md"}
"""Files next to the packages in a source distribution."""
BUILD_FILES = {"MANIFEST.in", "PKG-INFO", "pyproject.toml", "setup.cfg"}
MAX_BYTES = 5_000_000
"""Limit of a distribution. More means that a file is in it that should not be."""
RESOLUTIONS = {"newest": "highest", "oldest": "lowest-direct"}
"""Ways of uv to choose the versions of dependencies."""
BASE = (
    "uplift --version",
    "uplift samples",
    "uplift build --atlas macbeth --dim 8 -o small.uplift",
    "uplift query --cube small.uplift 0.8 0.2 0.1 --format json",
    "uplift export small.uplift -o small.h",
    "uplift texture uplift-samples/wood.png -o wood.exr",
    "uplift relight uplift-samples/wood.png -o wood.html",
    "uplift check small.uplift",
)
"""Commands of an installation without extras."""
EXTRAS = {
    "io": "uplift atlas uplift-samples/paints.xlsx",
    "plots": "uplift slices small.uplift --plot small.png",
}
"""A command for each extra that runs anywhere."""


def tracked_files(root: Path = ROOT) -> list[str]:
    """Return the files of the last commit, by paths from the root."""
    command = ["git", "ls-tree", "-r", "-z", "--name-only", "HEAD"]
    listed = subprocess.run(command, cwd=root, capture_output=True, check=True).stdout
    return [name for name in listed.decode().split("\0") if name]


def wheel_problems(path: Path, tracked: Iterable[str]) -> list[str]:
    """Return how a wheel differs from the packages in the source and their metadata."""
    with zipfile.ZipFile(path) as archive:
        names = set(archive.namelist())
    info = "-".join(path.name.split("-")[:2]) + ".dist-info"
    expected = {f"{info}/{name}" for name in WHEEL_INFO}
    expected |= {
        _installed(name) for name in tracked if name.partition("/")[0] in FOLDERS
    }
    return _differences(path, names, expected)


def source_problems(path: Path, tracked: Iterable[str]) -> list[str]:
    """Return how a source distribution differs from the packages in the source, the
    files next to them, and those of the build.
    """
    with tarfile.open(path) as archive:
        members = [member.name for member in archive if member.isfile()]
    names = {name.partition("/")[2] for name in members}
    names = {name for name in names if ".egg-info/" not in name}
    expected = SOURCE_FILES | BUILD_FILES
    expected |= {name for name in tracked if name.partition("/")[0] in FOLDERS}
    return _differences(path, names, expected)


def _installed(name: str) -> str:
    """Return the path in a wheel of a file of the source."""
    folder, *rest = PurePosixPath(name).parts
    return PurePosixPath(FOLDERS[folder], *rest).as_posix()


def _differences(path: Path, names: set[str], expected: set[str]) -> list[str]:
    """Return a line for each file too many or too few, and one for a large size."""
    lines = [f"{path.name}: lacks {name}" for name in sorted(expected - names)]
    lines += [f"{path.name}: has {name} as well" for name in sorted(names - expected)]
    if path.stat().st_size > MAX_BYTES:
        lines.append(f"{path.name}: more than {MAX_BYTES:,} bytes")
    return lines


def try_installation(wheel: Path, resolution: str, folder: Path) -> str:
    """Install a wheel into an empty environment, run commands in an empty folder, and
    return the versions of its dependencies. Raises `subprocess.CalledProcessError`.
    """
    pins = folder / "pins.txt"
    extras = [f"--extra={name}" for name in EXTRAS]
    shared = ["--quiet", "--resolution", resolution, f"--python={sys.executable}"]
    _uv("pip", "compile", *shared, *extras, "pyproject.toml", f"--output-file={pins}")
    environment = folder / "environment"
    _uv("venv", "--quiet", f"--python={sys.executable}", environment)
    install = ("pip", "install", "--quiet", f"--python={environment}", "-c", pins)
    home = folder / "home"
    home.mkdir()
    _uv(*install, wheel)
    for line in BASE:
        _run_installed(line, environment, home)
    _uv(*install, f"{wheel}[{','.join(EXTRAS)}]")
    for line in EXTRAS.values():
        _run_installed(line, environment, home)
    listed = subprocess.run(
        [sys.executable, "-m", "uv", "pip", "freeze", f"--python={environment}"],
        capture_output=True,
        text=True,
        check=True,
    )
    versions = [line for line in listed.stdout.split("\n") if "==" in line]
    return ", ".join(line.replace("==", " ") for line in versions)


def _uv(*words: object) -> None:
    command = [sys.executable, "-m", "uv", *map(str, words)]
    subprocess.run(command, cwd=ROOT, check=True)


def _run_installed(line: str, environment: Path, folder: Path) -> None:
    name, *words = line.split()
    scripts = environment / ("Scripts" if sys.platform == "win32" else "bin")
    command = [str(scripts / name), *words]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if done.returncode:
        print(f"{line}\n{done.stderr}", file=sys.stderr)
        done.check_returncode()


def main(folder: Path) -> int:
    """Check the distributions in a folder and print the results; return 1 if a check
    fails.
    """
    (source,) = folder.glob("*.tar.gz")
    (wheel,) = folder.glob("*.whl")
    tracked = tracked_files()
    problems = source_problems(source, tracked) + wheel_problems(wheel, tracked)
    for path in (source, wheel):
        print(f"{path.name}: {path.stat().st_size / 1e6:.1f} MB")
    for name, resolution in RESOLUTIONS.items():
        with tempfile.TemporaryDirectory() as temporary:
            try:
                versions = try_installation(
                    wheel.resolve(), resolution, Path(temporary)
                )
                print(f"{name} dependencies: all commands ran: {versions}")
            except subprocess.CalledProcessError as error:
                problems.append(f"{name} dependencies: {error}")
    print("\n".join(problems) or "no findings")
    return bool(problems)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
