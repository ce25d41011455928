"""Names of the parts of imported models, which a STEP file keeps as they are."""

from __future__ import annotations

LONGEST_NAME = 100
"""Of a part, in letters."""


class PartNames:
    """Names of parts as STEP files keep them, each once: printable, without quotes, not empty, not long."""

    def __init__(self) -> None:
        self._taken, self._numbers = set[str](), dict[str, int]()

    def unique(self, name: str) -> str:
        """Return the name that is closest to this one, with a number behind it if another part has that."""
        signs = (sign if sign.isprintable() and sign not in "'\"\\" else " " for sign in name[:LONGEST_NAME])
        plain = unique = " ".join("".join(signs).split()) or "part"
        number = self._numbers.get(plain, 1)
        while unique in self._taken:
            number += 1
            unique = f"{plain}_{number}"
        self._numbers[plain] = number
        self._taken.add(unique)
        return unique
