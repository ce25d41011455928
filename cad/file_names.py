"""File names of a design: `{design}_{model}_r{revision}`, in ASCII and in the user's spelling."""

from __future__ import annotations

import re
import unicodedata

LONGEST = 120  # limit of a design's name in UTF-8 [bytes]: file systems allow 255 for the whole file name
NAMELESS = "design"
_OTHER = re.compile(r"[^A-Za-z0-9.-]+")


def plain_name(text: str) -> str:
    """Return a text as an ASCII part of a file name: accents are removed, other characters become `_`."""
    letters = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()
    return _ends(_OTHER.sub("_", letters))


def name(text: str) -> str:
    """Return a text as part of a file name: letters and digits of any alphabet stay, others become `_`."""
    signs = (sign if _stays(sign) else "_" for sign in unicodedata.normalize("NFC", text))
    return _ends(re.sub("_+", "_", "".join(signs)))


def _stays(sign: str) -> bool:
    return sign.isalnum() or sign in ".-" or unicodedata.category(sign) in ("Mn", "Mc")


def _ends(text: str) -> str:
    return text.encode()[:LONGEST].decode(errors="ignore").strip("._-") or NAMELESS


def stem(design: str, model: str, revision: int) -> str:
    """Return the file name of a model without its extension, in ASCII."""
    return f"{plain_name(design)}_{model}_r{revision}"


def wide_stem(design: str, model: str, revision: int) -> str:
    """Return the file name of a model without its extension, in the user's spelling."""
    return f"{name(design)}_{model}_r{revision}"
