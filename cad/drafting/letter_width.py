"""Upper bounds of text widths over the fonts in which browsers and typesetters show a drawing.

The widths are those of DejaVu Sans, or of Arial and Liberation Sans for the capitals that are wider there.
The ISO lettering of CAD programs is narrower than all of them.
"""

from __future__ import annotations

from unicodedata import category, east_asian_width

SIZE = 1.3
"""Size of a font whose letters have height 1; a font's size is that of its line."""

_WIDTHS = {
    275: "'", 278: "ijl", 295: "I", 318: " ,.", 337: "/:;\\|", 352: "f", 361: "-", 390: "()[]", 392: "t",
    401: "!°³²", 411: "r", 460: '"', 500: "*_`–J", 521: "s", 525: "z", 531: "?", 550: "c", 557: "L",
    579: "k", 592: "vxy", 611: "FT", 612: "o", 613: "a", 615: "e", 634: "hnu", 635: "bdgpq",
    637: "$0123456789{}µ", 667: "EKPSY", 684: "AV", 685: "XZ", 686: "B", 722: "CR", 732: "U", 748: "N",
    752: "H", 770: "D", 778: "G", 780: "&", 788: "OQØ", 818: "w", 838: "#+<=>^~×±", 863: "M", 950: "%",
    974: "m", 989: "W", 1000: "@…",
}  # fmt: skip
_OF = {letter: width / 1000 for width, letters in _WIDTHS.items() for letter in letters}
_WIDE = 1.05  # a letter of East Asia
_PICTURE = 1.4  # an emoji
_OTHER = 1.0


def width_of(text: str, height: float) -> float:
    """Return the width of a line of text, in the unit in which the letter height is given."""
    return sum(_letter(sign) for sign in text) * SIZE * height


def clipped(text: str, width: float, height: float) -> str:
    """Return a text as one line of at most the given width; `…` replaces omitted text."""
    line = "".join(sign if sign.isprintable() else " " for sign in text)
    if width_of(line, height) <= width:
        return line
    room = width - width_of("…", height)
    for place, sign in enumerate(line):
        room -= width_of(sign, height)
        if room < 0:
            return f"{line[:place].rstrip()}…"
    return line


def _letter(sign: str) -> float:
    if sign in _OF:
        return _OF[sign]
    if ord(sign) >= 0x1F000:
        return _PICTURE
    if category(sign) in ("Mn", "Me"):
        return 0.0  # stands on the letter before it
    return _WIDE if east_asian_width(sign) in "WF" else _OTHER
