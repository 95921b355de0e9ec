"""The built zip, installed the way an artist installs it, where CasADi is nowhere else.

Slow: builds the zips (fetching the wheels at first) and starts Blender's module several times.
"""

import json
import os
import platform
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path
from typing import Any

import pytest
from hangtime.devtools.build import build
from hangtime.devtools.recordings import HOPS, find

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        (sys.platform, platform.machine()) != ("linux", "x86_64"),
        reason="the zip under test is the one for Linux on x86-64",
    ),
]

ROOT = Path(__file__).resolve().parents[2]
SHIPPED = {
    "LICENSE",
    "README.md",
    "__init__.py",
    "batch",
    "blender_manifest.toml",
    "bridge",
    "operators",
    "solver",
    "ui",
    "wheels",
}
ABSENT = ("casadi", "scipy", "mujoco")  # scipy_openblas32 too
OUTPUTS = {"adapted.blend", "adapted.fbx", "sheet.png", "report.json", "trajectory.npz"}

ANOTHER = """
schema_version = "1.0.0"
id = "another"
version = "1.0.0"
name = "Another"
tagline = "Brings wheels that Hangtime has too"
maintainer = "Nobody"
type = "add-on"
blender_version_min = "4.2.0"
license = ["SPDX:GPL-3.0-or-later"]
"""
IMPORTS_BOTH = """
import casadi, numpy
def register(): assert casadi.__version__ and numpy.__version__
def unregister(): pass
"""
FOR_UNREAL = """
[export]
engine = "unreal"
root = "root bone"
"""

# Both scripts end by os._exit: some versions of bpy crash or hang in an ordinary exit.
INSTALL = """
import importlib.util, json, os, sys
assert importlib.util.find_spec("casadi") is None, "casadi is there before the extension is"
import bpy
bpy.ops.extensions.package_install_files(
    filepath=sys.argv[1], repo="user_default", enable_on_install=True)
"""
REPORT_ORIGINS = """
import casadi, numpy, scipy_openblas32
enabled = "bl_ext.user_default.hangtime" in bpy.context.preferences.addons
print("ANSWER", json.dumps(
    {"casadi": casadi.__file__, "version": casadi.__version__, "numpy": numpy.__file__,
     "openblas": scipy_openblas32.__file__, "enabled": enabled}), flush=True)
os._exit(0)
"""
INSTALL_ANOTHER = """
bpy.ops.extensions.package_install_files(
    filepath=sys.argv[2], repo="user_default", enable_on_install=True)
from bl_ext.user_default import another
"""
ADAPT = """
from bl_ext.user_default.hangtime.operators.headless import cli
code = cli.main(["adapt", sys.argv[2], "--recipe", sys.argv[3], "--out", sys.argv[4]])
print("ANSWER", json.dumps({"code": code}), flush=True)
os._exit(0)
"""


@pytest.fixture(scope="module")
def zips(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The built zip of each platform, by the platform's name."""
    out = tmp_path_factory.mktemp("dist")
    return {z.stem.split("-")[-1].replace("_", "-"): z for z in build(out)}


@pytest.fixture(scope="module")
def bare_python(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A Python with Blender's module and what belongs to Blender, but without our dependencies.

    It borrows this environment's packages by links, so that a gigabyte need not be installed twice.
    """
    folder = tmp_path_factory.mktemp("bare")
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", str(folder)], check=True)
    own = Path(sysconfig.get_path("purelib"))
    borrowed = folder / own.relative_to(sys.prefix)
    for entry in own.iterdir():
        if not entry.name.lower().lstrip("_").startswith(ABSENT) and entry.suffix != ".pth":
            (borrowed / entry.name).symlink_to(entry)
    return folder / "bin" / "python"


def run_installed(python: Path, user: Path, script: str, *arguments: str) -> dict[str, Any]:
    """Install the zip (the first argument) into an empty user folder, then run `script`."""
    user.mkdir()
    done = subprocess.run(
        [str(python), "-c", INSTALL + script, *arguments],
        env={**os.environ, "BLENDER_USER_RESOURCES": str(user)},
        cwd=user,
        capture_output=True,
        text=True,
        timeout=600,
    )
    answers = [x for x in done.stdout.splitlines() if x.startswith("ANSWER ")]
    assert answers, f"exit code {done.returncode}\n{done.stdout}\n{done.stderr}"
    answer: dict[str, Any] = json.loads(answers[-1].removeprefix("ANSWER "))
    return {**answer, "said": done.stdout + done.stderr}


@pytest.mark.parametrize(
    "name", ["linux-x64", "linux-arm64", "windows-x64", "macos-arm64", "macos-x64"]
)
def test_a_zip_holds_the_extension_and_its_wheels(zips: dict[str, Path], name: str) -> None:
    with zipfile.ZipFile(zips[name]) as archive:
        members = [Path(m) for m in archive.namelist()]
    assert {m.parts[0] for m in members} <= SHIPPED
    assert {"LICENSE", "__init__.py", "blender_manifest.toml"} <= {str(m) for m in members}
    wheels = [m.name for m in members if m.suffix == ".whl"]
    assert [w.split("-")[0] for w in wheels] == ["casadi", "scipy_openblas32"]
    code = {".py", ".toml", ".md", ".whl", ""}
    page = {".html", ".css", ".js", ".png"}  # of a batch
    assert code >= {m.suffix for m in members if m.parts[0] != "batch"}
    assert code | page >= {m.suffix for m in members}


def test_casadi_and_openblas_come_from_the_extension(
    zips: dict[str, Path], bare_python: Path, tmp_path: Path
) -> None:
    user = tmp_path / "user"
    answer = run_installed(bare_python, user, REPORT_ORIGINS, str(zips["linux-x64"]))
    assert answer["enabled"], answer["said"]
    assert answer["version"] == "3.8.2"
    assert Path(answer["casadi"]).is_relative_to(user)
    assert Path(answer["openblas"]).is_relative_to(user)
    assert not Path(answer["numpy"]).is_relative_to(user), "numpy is Blender's own"


def add_wheel(folder: Path, name: str, version: str) -> str:
    """A wheel of a package that only tells its version; its name."""
    wheel, info = f"{name}-{version}-py3-none-any.whl", f"{name}-{version}.dist-info"
    with zipfile.ZipFile(folder / wheel, "w") as archive:
        archive.writestr(f"{name}/__init__.py", f'__version__ = "{version}"')
        archive.writestr(f"{info}/WHEEL", "Wheel-Version: 1.0\nRoot-Is-Purelib: true\n")
        archive.writestr(f"{info}/METADATA", f"Name: {name}\nVersion: {version}\n")
        archive.writestr(f"{info}/RECORD", f"{name}/__init__.py,,\n")
    return wheel


def another_extension(folder: Path) -> Path:
    """The zip of an extension that brings an older CasADi and a newer numpy."""
    wheels = [add_wheel(folder, "casadi", "3.6.7"), add_wheel(folder, "numpy", "99.0.0")]
    manifest = ANOTHER + "wheels = " + json.dumps([f"./wheels/{wheel}" for wheel in wheels])
    with zipfile.ZipFile(folder / "another-1.0.0.zip", "w") as archive:
        archive.writestr("blender_manifest.toml", manifest)
        archive.writestr("__init__.py", IMPORTS_BOTH)
        for wheel in wheels:
            archive.write(folder / wheel, f"wheels/{wheel}")
    return folder / "another-1.0.0.zip"


def test_another_extension_s_casadi_and_numpy_break_neither(
    zips: dict[str, Path], bare_python: Path, tmp_path: Path
) -> None:
    user, other = tmp_path / "user", another_extension(tmp_path)
    given = (str(zips["linux-x64"]), str(other))
    answer = run_installed(bare_python, user, INSTALL_ANOTHER + REPORT_ORIGINS, *given)
    assert answer["enabled"], answer["said"]
    assert answer["version"] == "3.8.2", "of two wheels Blender takes the newer"
    assert not Path(answer["numpy"]).is_relative_to(user), "Blender's own goes before any wheel"


def test_the_installed_extension_does_the_main_job(
    zips: dict[str, Path], bare_python: Path, tmp_path: Path
) -> None:
    clip = find(HOPS)
    recipe, out = tmp_path / "recipe.toml", tmp_path / "out"
    demo = (ROOT / "examples" / "demo_hop.toml").read_text(encoding="utf-8")
    recipe.write_text(f"{demo}\n{FOR_UNREAL}", encoding="utf-8")
    given = (str(zips["linux-x64"]), str(clip), str(recipe), str(out))
    answer = run_installed(bare_python, tmp_path / "user", ADAPT, *given)
    assert answer["code"] == 0, answer["said"]
    assert {p.name for p in out.iterdir() if p.stat().st_size > 0} >= OUTPUTS
    assert b"Armature\x00\x01Model" in (out / "adapted.fbx").read_bytes()
    assert "status" in json.loads((out / "report.json").read_text(encoding="utf-8"))
