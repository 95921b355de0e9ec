"""A number that is typed during a drag, without Blender."""

from dataclasses import dataclass


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
            self.digits += "" if "." in self.digits else "."
        elif character.isascii() and character.isdigit():
            self.digits += character
        else:
            return False
        return True

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
