"""Parser of apt's sources, for the mirror of this machine's Debian. Standard library only."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

APT = Path("/etc/apt")
RELEASE = Path("/etc/os-release")


@dataclass(frozen=True)
class Source:
    """One place that packages come from; the suites ("trixie") and components it is read for."""

    place: str
    suites: tuple[str, ...]
    components: tuple[str, ...]


def mirror(apt: Path = APT, release: Path = RELEASE) -> str | None:
    """The mirror of this machine's own release of Debian; None where its sources do not say."""
    own = variables(release).get("VERSION_CODENAME")
    for source in sources(apt):
        if own in source.suites and "main" in source.components:
            return source.place
    return None


def variables(release: Path) -> dict[str, str]:
    """The assignments of an os-release file; none where there is no such file."""
    if not release.is_file():
        return {}
    pairs = (line.partition("=") for line in release.read_text().splitlines() if "=" in line)
    return {name.strip(): value.strip().strip("\"'") for name, _, value in pairs}


def sources(apt: Path) -> Iterator[Source]:
    """Every binary source that apt reads in the folder `apt`, in both of its formats."""
    folder = apt / "sources.list.d"
    for file in (apt / "sources.list", *sorted(folder.glob("*.list"))):
        if file.is_file():
            yield from one_line_sources(file.read_text())
    for file in sorted(folder.glob("*.sources")):
        yield from stanza_sources(file.read_text())


def one_line_sources(text: str) -> Iterator[Source]:
    """Lines such as `deb [option=value] PLACE SUITE COMPONENT...`."""
    for line in text.splitlines():
        kind, _, rest = line.partition("#")[0].strip().partition(" ")
        if kind != "deb":
            continue
        if rest.lstrip().startswith("["):
            rest = rest.partition("]")[2]
        place, suite, *components = rest.split()
        yield Source(place, (suite,), tuple(components))


def stanza_sources(text: str) -> Iterator[Source]:
    """Stanzas of `Field: value` lines (deb822), parted by empty lines."""
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    for stanza in "\n".join(line.rstrip() for line in lines).split("\n\n"):
        fields = stanza_fields(stanza)
        if "deb" not in fields.get("types", []) or fields.get("enabled") == ["no"]:
            continue
        suites, components = (tuple(fields.get(name, ())) for name in ("suites", "components"))
        for place in fields.get("uris", []):
            yield Source(place, suites, components)


def stanza_fields(stanza: str) -> dict[str, list[str]]:
    """Each field's words by its name in lower case; a line that begins with a space goes on."""
    fields: dict[str, list[str]] = {}
    name = ""
    for line in stanza.splitlines():
        value = line
        if not line.startswith((" ", "\t")):
            name, _, value = line.partition(":")
            name = name.strip().lower()
        fields.setdefault(name, []).extend(value.split())
    return fields
