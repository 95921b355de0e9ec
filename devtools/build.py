"""Makes the extension's zips, one per platform, with Blender's own builder, and validates them; and
the wheel for machines without Blender."""

import argparse
import importlib.util
import subprocess
import sys
import tempfile
import tomllib
from hashlib import sha256
from pathlib import Path

from .environment.virtual_environment import ROOT
from .wheel import BuildError, build_wheel, pins

MOST_BYTES = 200_000_000  # of a zip that extensions.blender.org takes


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="dev.py build", description=__doc__)
    parser.add_argument("--out", default="dist", type=Path, metavar="DIR", help="default: dist")
    out: Path = parser.parse_args(argv).out
    try:
        for made in (*build(out), build_wheel(out)):
            print(f"{made}  {made.stat().st_size / 1e6:.3g} MB")
    except (BuildError, OSError) as problem:
        print(problem, file=sys.stderr)
        return 1
    return 0


def build(out: Path) -> list[Path]:
    """Write and validate the zips in `out`; their paths. Raises BuildError."""
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
    for wheel in manifest["wheels"]:
        fetch(ROOT / wheel)
    out.mkdir(parents=True, exist_ok=True)
    stem = f"{manifest['id']}-{manifest['version']}"
    for stale in out.glob(f"{stem}-*.zip"):
        stale.unlink()
    builder("build", "--source-dir", str(ROOT), "--output-dir", str(out), "--split-platforms")
    zips = sorted(out.glob(f"{stem}-*.zip"))
    if len(zips) != len(manifest["platforms"]):
        raise BuildError(f"Expected a zip for each of {manifest['platforms']}, got {zips}.")
    for zipped in zips:
        builder("validate", str(zipped))
        if zipped.stat().st_size > MOST_BYTES:
            raise BuildError(f"{zipped} is beyond the {MOST_BYTES / 1e6:.0f} MB that are taken.")
    return zips


def fetch(wheel: Path) -> None:
    """Have the unmodified wheel at that path, its hash among its package's pinned ones.

    A wheel for several platforms joined by dots is stored under the first one's name alone:
    Blender's builder does not read the joined form.
    """
    if wheel.is_file() and pinned(wheel):
        return
    platform, package = wheel.stem.rpartition("-")[2], distribution(wheel)
    print(f"Fetching {wheel.name} ...", flush=True)
    command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-input", "--no-deps"]
    command += ["--disable-pip-version-check", "--only-binary", ":all:", "--platform", platform]
    command += ["--implementation", "cp", "--python-version", "3.11", "--abi", "abi3"]
    command += ["--abi", "none", "--require-hashes"]
    wheel.parent.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(dir=wheel.parent) as scratch:
        requirement = Path(scratch, "requirement.txt")
        requirement.write_text(pins()[package], encoding="utf-8")
        run([*command, "-r", str(requirement), "-d", scratch])
        found = list(Path(scratch).glob("*.whl"))
        if len(found) != 1 or not pinned(found[0]):
            raise BuildError(f"No wheel with a pinned hash came for {platform}: {found}.")
        found[0].replace(wheel)


def distribution(wheel: Path) -> str:
    return wheel.name.partition("-")[0].replace("_", "-")


def pinned(wheel: Path) -> bool:
    digest = sha256(wheel.read_bytes()).hexdigest()
    return f"--hash=sha256:{digest}" in pins()[distribution(wheel)].split()


def builder(*arguments: str) -> None:
    """Run Blender's extension tool, which is a program of its own within the module."""
    spec = importlib.util.find_spec("bpy")
    assert spec is not None
    assert spec.origin is not None
    tool = next(Path(spec.origin).parent.glob("*/scripts/addons_core/bl_pkg/cli/blender_ext.py"))
    run([sys.executable, str(tool), *arguments])


def run(command: list[str]) -> None:
    """Raises BuildError with everything the command said, if it fails."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        raise BuildError(f"{done.stdout}\nfailed: {' '.join(command)}")
