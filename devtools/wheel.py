"""Makes the wheel for machines without Blender: `hangtime-batch`, and of the package what it needs.

What `batch` imports, and what that imports, goes in; the rest of the package needs Blender. In the
wheel the package is laid out as in the extension, so relative imports mean the same in both.
"""

import ast
import json
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

from .environment.virtual_environment import REQUIREMENTS, ROOT

BEGIN = ROOT / "batch"
MANIFEST = "blender_manifest.toml"  # tells the version at run time too
OF_BLENDER = {"bpy", "bpy_extras", "bmesh", "gpu", "mathutils"}
MADE_AT = "1577836800"  # s since 1970, the first of 2020: the same sources make the same bytes

PROJECT = """\
[build-system]
requires = ["flit_core==3.12.0"]
build-backend = "flit_core.buildapi"

[project]
name = "hangtime"
version = "{version}"
description = "Adapts recorded jumps by physics: batches on machines without Blender"
license = "GPL-3.0-or-later"
requires-python = ">=3.11"
dependencies = {dependencies}

[project.optional-dependencies]
dask = ["distributed>=2025.1"]

[project.scripts]
hangtime-batch = "hangtime.batch.cli:main"
"""


class BuildError(Exception):
    """Says in one sentence what could not be built."""


def build_wheel(out: Path) -> Path:
    """Make the wheel in `out`; its path. Raises BuildError, as where a part of it needs Blender."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        for file in wheel_files():
            target = folder / "hangtime" / file.relative_to(ROOT)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, target)
        version = tomllib.loads((ROOT / MANIFEST).read_text("utf-8"))["version"]
        dependencies = ["numpy>=1.26", *(pin.split()[0] for pin in pins().values())]
        project = PROJECT.format(version=version, dependencies=json.dumps(dependencies))
        (folder / "pyproject.toml").write_text(project, encoding="utf-8")
        command = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-input", "--no-deps"]
        command += ["--disable-pip-version-check", "-w", scratch, scratch]
        variables = os.environ | {"SOURCE_DATE_EPOCH": MADE_AT}
        done = subprocess.run(command, env=variables, capture_output=True, text=True)
        if done.returncode != 0:
            raise BuildError(f"{done.stdout}{done.stderr}\nfailed: {' '.join(command)}")
        made = next(folder.glob("*.whl"))
        out.mkdir(parents=True, exist_ok=True)
        return Path(shutil.copyfile(made, out / made.name))  # pip's own is for its owner alone


def pins() -> dict[str, str]:
    """By package the line of requirements that pins its wheels, with a hash for each platform."""
    text = (REQUIREMENTS / "wheels.txt").read_text(encoding="utf-8").replace("\\\n", "")
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    return {line.partition("==")[0]: line for line in lines}


def wheel_files() -> list[Path]:
    """Every file that goes in: what `batch` imports as it loads, what functions import where that
    needs no Blender, the packages of these, and their data.

    Raises BuildError where a module that a batch loads needs Blender.
    """
    modules = loaded_by(BEGIN.rglob("*.py"))
    for module in sorted(modules):
        if blender := outside(module) & OF_BLENDER:
            where = module.relative_to(ROOT)
            raise BuildError(f"{where} is loaded by a batch and needs {min(blender)}.")
    waiting = modules
    while waiting:
        later = (loaded_by([each]) for module in waiting for each in imported(module, later=True))
        waiting = {each for group in later if not needs_blender(group) for each in group} - modules
        modules |= waiting
    data = {
        file
        for folder in {module.parent for module in modules} - {ROOT}
        for file in (*folder.glob("*"), *folder.glob("*/*"))
        if file.is_file() and file.suffix not in (".py", ".pyc") and package_of(file) == folder
    }
    return sorted(modules | data | {ROOT / MANIFEST})


def package_of(file: Path) -> Path:
    """The folder of the package that a file belongs to."""
    return next(folder for folder in file.parents if (folder / "__init__.py").is_file())


def needs_blender(modules: set[Path]) -> bool:
    return any(outside(module) & OF_BLENDER for module in modules)


def loaded_by(begin: Iterable[Path]) -> set[Path]:
    """The modules, and all within the package that these import as they load. What the package
    itself imports is for Blender, which registers it."""
    found: set[Path] = set()
    waiting = set(begin)
    while waiting:
        found |= waiting
        waiting = {each for module in waiting for each in imported(module)} - found
    return found


@cache
def imported(module: Path, *, later: bool = False) -> frozenset[Path]:
    """Files of the package that one imports as it loads, or `later`, in functions; and the packages
    that it is in."""
    found = {folder / "__init__.py" for folder in module.parents if folder.is_relative_to(ROOT)}
    for node in imports(module, later):
        if isinstance(node, ast.ImportFrom) and node.module == "pkgutil":
            found |= set(module.parent.glob("*.py"))  # it takes whatever lies beside it
        elif isinstance(node, ast.ImportFrom) and node.level:
            folder = module.parents[node.level - 1].joinpath(*(node.module or "").split("."))
            for name in ("", *(each.name for each in node.names)):
                found |= {(folder / name).with_suffix(".py"), folder / name / "__init__.py"}
    return frozenset(file for file in found if file.is_file())


def outside(module: Path) -> set[str]:
    """First parts of the names that a module imports from elsewhere as it loads."""
    names = set()
    for node in imports(module, later=False):
        if isinstance(node, ast.Import):
            names |= {each.name for each in node.names}
        elif not node.level and node.module:
            names.add(node.module)
    return {name.partition(".")[0] for name in names}


@cache
def imports(module: Path, later: bool) -> tuple[ast.Import | ast.ImportFrom, ...]:
    """Import statements outside of functions, or within them; none that only types need."""
    found = statements(ast.parse(module.read_text(encoding="utf-8")), within=False)
    return tuple(
        node
        for node, within in found
        if isinstance(node, ast.Import | ast.ImportFrom) and within is later
    )


def statements(tree: ast.AST, *, within: bool) -> Iterator[tuple[ast.AST, bool]]:
    """Every node, and whether it is within a function."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            continue
        inside = within or isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda)
        yield node, inside
        yield from statements(node, within=inside)
