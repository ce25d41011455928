r"""Character classes for the patterns of texts.

They list code points, because Pydantic and JSON Schema disagree on what `\s` matches (U+0085, U+FEFF).
"""

CONTROL = r"\x00-\x1f\x7f-\x9f\u2028\u2029"
"""Control characters and line ends."""

BLANK = CONTROL + r"\x20\xa0\u1680\u2000-\u200a\u202f\u205f\u3000\ufeff"
"""Invisible characters: control characters and spaces of any width."""

LINE = rf"^[^{BLANK}]([^{CONTROL}]*[^{BLANK}])?$"
"""One line that neither starts nor ends with a space."""
