"""A number that is typed during a drag, without Blender."""

from dataclasses import dataclass

MOST_DIGITS = 9  # with the point; the rest would be lost in single precision


@dataclass
class TypedNumber:
    """As Blender takes it: digits with a point or a comma, a minus that turns its sign wherever it
    comes, and a backspace, after whose last the mouse leads again."""

    digits: str = ""
    negative: bool = False

    def key(self, kind: str, character: str) -> bool:
        """Takes a key, by Blender's name of it and what it writes; False for one of no number."""
        if kind == "BACK_SPACE" and self:
            self.digits, self.negative = self.digits[:-1], self.negative and bool(self.digits)
        elif character == "-":
            self.negative = not self.negative
        elif character and character in ".,":
            self._add("" if "." in self.digits else ".")
        elif character.isascii() and character.isdigit():
            self._add(character)
        else:
            return False
        return True

    def _add(self, character: str) -> None:
        if len(self.digits) < MOST_DIGITS:
            self.digits += character

    def __bool__(self) -> bool:
        """Whether anything is typed, such as a minus."""
        return self.negative or bool(self.digits)

    def __str__(self) -> str:
        return f"{'-' if self.negative else ''}{self.digits}"

    @property
    def value(self) -> float:
        """What it is so far; 0 of nothing."""
        size = float(f"0{self.digits}")
        return -size if self.negative else size
