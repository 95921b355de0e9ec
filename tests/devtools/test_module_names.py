"""Modules and their members that devtools names in strings exist: no import would tell."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from hangtime.devtools.environment.virtual_environment import ROOT

LOADER = "extension_module"  # loads a module of the installed extension by its name
SOURCES = [ROOT / "dev.py", *sorted((ROOT / "devtools").rglob("*.py"))]
TOP = "(?:devtools|benchmarks|operators|bridge|solver|ui)"
DOTTED = re.compile(rf"\b{TOP}(?:\.[a-z_]\w*)+(?![\w./])")
FILES = re.compile(rf"\b({TOP}/[\w/]+)\\?\.py")  # with a backslash where it is a pattern


def source_of(module: str) -> Path | None:
    """The file of a module of the checkout, None where there is none."""
    path = ROOT.joinpath(*module.split("."))
    files = (path.with_suffix(".py"), path / "__init__.py")
    return next((file for file in files if file.is_file()), None)


def strings(tree: ast.AST) -> Iterator[str]:
    """String constants, docstrings left out: those are for people."""
    docs = {
        id(node.body[0].value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef)
        and node.body
        and isinstance(node.body[0], ast.Expr)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and id(node) not in docs:
            if isinstance(node.value, str):
                yield node.value
            elif isinstance(node.value, bytes):
                yield node.value.decode("latin-1")


def loaded_members(tree: ast.AST) -> Iterator[tuple[str, str]]:
    """(module, member) of every `extension_module("module").member`."""
    for node in ast.walk(tree):
        if (
            isinstance(node, ast.Attribute)
            and isinstance(node.value, ast.Call)
            and isinstance(node.value.func, ast.Name)
            and node.value.func.id == LOADER
        ):
            yield ast.literal_eval(node.value.args[0]), node.attr


def defined(file: Path) -> set[str]:
    """Names that a module binds at its top level."""
    names: set[str] = set()
    for node in ast.parse(file.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            names.add(node.name)
        elif isinstance(node, ast.Import | ast.ImportFrom):
            names.update(alias.asname or alias.name for alias in node.names)
        else:
            names.update(n.id for n in ast.walk(node) if isinstance(n, ast.Name))
    return names


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: str(path.relative_to(ROOT)))
def test_modules_in_strings_exist(source: Path) -> None:
    tree = ast.parse(source.read_text(encoding="utf-8"))
    named = {name for text in strings(tree) for name in DOTTED.findall(text)}
    named |= {path.replace("/", ".") for text in strings(tree) for path in FILES.findall(text)}
    assert {name for name in named if source_of(name) is None} == set()


def test_members_of_the_installed_extension_exist() -> None:
    trees = [ast.parse(source.read_text(encoding="utf-8")) for source in SOURCES]
    used = {pair for tree in trees for pair in loaded_members(tree)}
    assert used, f"nothing is loaded by {LOADER}"
    missing = [
        (module, member)
        for module, member in used
        if (file := source_of(module)) is None or member not in defined(file)
    ]
    assert missing == []
