"""Limits of the code base: files a folder, import depth, circles of folders, unique class names."""

import ast
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from graphlib import CycleError, TopologicalSorter
from itertools import pairwise
from pathlib import Path

import grimp

PACKAGE = "hangtime"
LAYERS = ("solver", "bridge", "operators", "batch", "ui", "devtools", "benchmarks")
MAX_FILES = 14  # Python files in a folder
MAX_DEPTH = 8  # modules on the longest import chain within a folder

Graph = Mapping[Path, set[Path]]


def problems(root: Path) -> Iterator[str]:
    """A sentence for each limit that the checkout at `root` exceeds, with the files."""
    imports = import_graph(root)
    tests = [path.relative_to(root) for path in (root / "tests").rglob("*.py")]
    yield from crowded([*imports, *tests])
    yield from deep(imports)
    yield from circular(imports)
    for layer in LAYERS:
        classes = {f: public_classes(root / f) for f in imports if f.parts[0] == layer}
        yield from ambiguous(classes)


def import_graph(root: Path, package: str = PACKAGE) -> Graph:
    """The files, relative to `root`, that each file of the layers imports; imports in functions and
    for types count."""
    graph = grimp.build_graph(package, cache_dir=None)
    inside = tuple(f"{package}.{layer}" for layer in LAYERS)
    files = {name: file_of(name, root) for name in graph.modules if name.startswith(inside)}
    return {
        file: {files[t] for t in graph.find_modules_directly_imported_by(name) if t in files}
        for name, file in sorted(files.items())
    }


def file_of(module: str, root: Path) -> Path:
    """The path of a module's file, relative to `root`."""
    path = Path(*module.split(".")[1:])
    return path / "__init__.py" if (root / path).is_dir() else path.with_suffix(".py")


def crowded(files: Iterable[Path]) -> Iterator[str]:
    """Folders with more than MAX_FILES of the files."""
    folders: defaultdict[Path, list[Path]] = defaultdict(list)
    for file in files:
        folders[file.parent].append(file)
    for folder, own in sorted(folders.items()):
        if len(own) > MAX_FILES:
            names = ", ".join(sorted(file.name for file in own))
            yield f"{folder} has {len(own)} files, at most {MAX_FILES} may be: {names}"


def deep(imports: Graph) -> Iterator[str]:
    """Import chains within a folder of more than MAX_DEPTH modules."""
    for folder in sorted({file.parent for file in imports}):
        own = {file for file in imports if file.parent == folder}
        try:
            chain = longest_chain({file: imports[file] & own for file in own})
        except CycleError as error:
            chain = list(reversed(error.args[1]))
            yield "import circle: " + " -> ".join(map(str, chain))
            continue
        if len(chain) > MAX_DEPTH:
            names = " -> ".join(map(str, chain))
            yield f"import chain of {len(chain)} files, at most {MAX_DEPTH} may be: {names}"


def longest_chain(graph: Graph) -> list[Path]:
    """The longest path through an acyclic graph. Raises CycleError."""
    chains: dict[Path, list[Path]] = {}
    for node in TopologicalSorter(graph).static_order():
        chains[node] = [node, *max((chains[target] for target in graph[node]), key=len, default=[])]
    return max(chains.values(), key=len)


def circular(imports: Graph) -> Iterator[str]:
    """A circle of folders, with an import that makes each of its steps."""
    steps = {
        (file.parent, target.parent): f"{file} -> {target}"
        for file, targets in imports.items()
        for target in targets
        if file.parent != target.parent
    }
    folders: defaultdict[Path, set[Path]] = defaultdict(set)
    for importer, imported in steps:
        folders[importer].add(imported)
    try:
        TopologicalSorter(folders).prepare()
    except CycleError as error:
        circle = pairwise(reversed(error.args[1]))
        yield "circle of folders: " + ", ".join(steps[step] for step in circle)


def public_classes(file: Path) -> list[str]:
    """Names of the public classes that a file defines at its top level."""
    body = ast.parse(file.read_text(encoding="utf-8")).body
    names = [node.name for node in body if isinstance(node, ast.ClassDef)]
    return [name for name in names if not name.startswith("_")]


def ambiguous(classes: Mapping[Path, Iterable[str]]) -> Iterator[str]:
    """Class names that more than one file defines."""
    places: defaultdict[str, list[str]] = defaultdict(list)
    for file, names in classes.items():
        for name in names:
            places[name].append(str(file))
    for name, files in sorted(places.items()):
        if len(files) > 1:
            yield f"class {name} is defined more than once: {', '.join(files)}"
