"""Damage to files: of their bytes, and of the words of a text."""

from collections.abc import Callable, Sequence
from pathlib import Path

from .case import HostileCase

NASTY = (
    *("nan", "inf", "-inf", "1e400", "-1e308", "1e308", "1e-320", "0", "-0.0", "-1", "2", "0.5"),
    *("1e6", "-1e5", "999999999999999999999", "1_0", "0x10", "x", "", "None", "true", "'", '"'),
    *("²", "\u0661", "\x00", "\ufeff", "\u2028", "ROOT", "JOINT", "End", "{", "}", "begin", "end"),
    *(":root", ":units", "#", "[", "]", "[[", "=", "f", "v", "1/2/3", "rx", "XYZ", "1" * 400),
)


FACTORS = (-1.0, 0.0, 1e-6, 0.1, 1.0, 1.0, 2.54, 10.0, 1e3, 1e6)
SHIFTS = (0.0, 0.0, 0.0, 0.01, 1.0, -90.0, 180.0, 1e4)


def damaged_bytes(case: HostileCase, data: bytes) -> bytes:
    """One to three bytes flipped, taken out, put in or moved; or the file cut off."""
    for _ in range(int(case.rng.integers(1, 4))):
        at, end = sorted(case.rng.integers(0, len(data) + 1, 2).tolist())
        junk = case.rng.bytes(int(case.rng.integers(1, 9)))
        data = case.pick(
            (
                data[:at] + junk + data[at + len(junk) :],
                data[:at] + junk + data[at:],
                data[:at],
                data[:at] + data[min(end, at + 200) :],
                data[:end] + data[at:],
            )
        )
    return data


def damaged_text(case: HostileCase, text: str) -> str:
    """One to four words or lines changed."""
    lines = text.split("\n")
    for _ in range(int(case.rng.integers(1, 5))):
        at = int(case.rng.integers(len(lines)))
        case.pick(LINE_CHANGES)(case, lines, at)
        lines = lines or [""]
    return case.pick(("\n", "\n", "\n", "\n", "\r\n", "\r")).join(lines)


def damaged_values(case: HostileCase, text: str) -> str:
    """Decimal numbers of one to four lines scaled, moved, or another line's: the form stays."""
    lines = text.split("\n")
    numbers = [i for i, line in enumerate(lines) if any(map(_decimal, line.split()))]
    for _ in range(int(case.rng.integers(1, 5)) if numbers else 0):
        at, share = case.pick(numbers), case.pick((0.02, 0.3, 1.0))
        factor, more = case.pick(FACTORS), case.pick(SHIFTS)
        if case.chance(0.2):
            lines[at] = _like(lines[at], lines[case.pick(numbers)])
        words = lines[at].split(" ")
        lines[at] = " ".join(
            f"{factor * float(word) + more:.7f}" if _decimal(word) and case.chance(share) else word
            for word in words
        )
    return "\n".join(lines)


def write_damaged(case: HostileCase, path: Path, text: str) -> None:
    """A file with a damaged text, half of them in values alone, which are read and go further."""
    match case.pick(("bytes", "text", "values", "values")):
        case "bytes":
            path.write_bytes(damaged_bytes(case, text.encode()))
        case "text":
            path.write_text(damaged_text(case, text), encoding="utf-8", newline="")
        case _:
            path.write_text(damaged_values(case, text), encoding="utf-8")


def _like(line: str, other: str) -> str:
    """The other line where it has as many words."""
    return other if len(other.split()) == len(line.split()) else line


def _decimal(word: str) -> bool:
    """Whether it is written as a number that need not be whole."""
    return "." in word and word.lstrip("-").replace(".", "", 1).isdecimal()


def _word(case: HostileCase, lines: list[str], at: int) -> None:
    words = lines[at].split(" ")
    words[int(case.rng.integers(len(words)))] = case.pick(NASTY)
    lines[at] = " ".join(words)


def _number(case: HostileCase, lines: list[str], at: int) -> None:
    """Another number in place of one of the line's, if it has any."""
    words = lines[at].split(" ")
    places = [i for i, word in enumerate(words) if word.lstrip("-").replace(".", "").isdecimal()]
    if places:
        words[case.pick(places)] = case.pick(NASTY[:18])
    lines[at] = " ".join(words)


def _extra(case: HostileCase, lines: list[str], at: int) -> None:
    lines[at] += f" {case.pick(NASTY)}"


def _shorter(_: HostileCase, lines: list[str], at: int) -> None:
    lines[at] = lines[at].rpartition(" ")[0]


def _gone(_: HostileCase, lines: list[str], at: int) -> None:
    del lines[at]


def _twice(_: HostileCase, lines: list[str], at: int) -> None:
    lines.insert(at, lines[at])


def _swapped(case: HostileCase, lines: list[str], at: int) -> None:
    other = int(case.rng.integers(len(lines)))
    lines[at], lines[other] = lines[other], lines[at]


def _cut(case: HostileCase, lines: list[str], at: int) -> None:
    if case.chance(0.3):
        del lines[at:]


def _borrowed(case: HostileCase, lines: list[str], at: int) -> None:
    """The last word of another line."""
    lines[at] = f"{lines[at].rpartition(' ')[0]} {case.pick(lines).rpartition(' ')[2]}"


LINE_CHANGES: Sequence[Callable[[HostileCase, list[str], int], None]] = (
    *(_word, _number, _number, _extra, _shorter, _gone, _twice, _swapped, _cut, _borrowed),
)
