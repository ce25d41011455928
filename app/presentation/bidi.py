"""Isolate user-given names on pages, so that right-to-left marks do not affect the text around them.

U+202E and similar characters are legal in names. Unisolated, they reverse the text that follows. `balanced`
is for text in an isolating element (`<bdi>`); `bare` is for titles and PDF, which have no such elements.
"""

from __future__ import annotations

EMBEDDINGS = "\u202a\u202b\u202d\u202e"  # left, right, and both overrides; ended by POP_EMBEDDING
ISOLATES = "\u2066\u2067\u2068"  # ended by POP_ISOLATE
POP_EMBEDDING, POP_ISOLATE = "\u202c", "\u2069"
MARKS = "\u200e\u200f\u061c"
BREAKS = "\u2028\u2029\x85"  # a new paragraph ends every isolation

_WITHOUT_BREAKS = dict.fromkeys(map(ord, BREAKS), " ")
_WITHOUT_CONTROLS = dict.fromkeys(map(ord, EMBEDDINGS + ISOLATES + POP_EMBEDDING + POP_ISOLATE + MARKS))


def bare(text: str) -> str:
    """Return a text without the characters that only change the reading direction."""
    return text.translate(_WITHOUT_CONTROLS | _WITHOUT_BREAKS)


def balanced(text: str) -> str:
    """Return a text in which every character that ends a bidi isolation has one that starts it."""
    text = text.translate(_WITHOUT_BREAKS)
    if POP_ISOLATE not in text:
        return text
    kept, isolates = [], 0
    for sign in text:
        if sign == POP_ISOLATE and isolates == 0:
            continue
        isolates += (sign in ISOLATES) - (sign == POP_ISOLATE)
        kept.append(sign)
    return "".join(kept)


def bare_everywhere(data: object) -> object:
    """Return plain JSON data after applying `bare` to every text and name in it."""
    if isinstance(data, str):
        return bare(data)
    if isinstance(data, dict):
        return {bare_everywhere(name): bare_everywhere(value) for name, value in data.items()}
    if isinstance(data, list | tuple):
        return [bare_everywhere(item) for item in data]
    return data
