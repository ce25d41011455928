"""U+0000, the character that no text of a request may have: PostgreSQL cannot store it.

It is refused where requests are read, for both kinds of database, by the name of the field that has it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from itertools import islice

from fastapi import Request
from starlette.exceptions import HTTPException

from templates.core.errors import Fault, InvalidInputs, plain

NUL = "\0"
MOST_NAMED = 20
DETAIL = "no text may have the character U+0000 (NUL); leave it out: {}"
_ESCAPED = b"\\u0000"
_CHARACTER = re.compile(rb"(?<!\\)(?:\\\\)*\\u0000")
"""It itself in JSON; an escaped backslash may stand before `u0000`."""


def refuse_in_address(request: Request) -> None:
    """Refuse an address with U+0000.

    Raises
    ------
    HTTPException
        With 404, if the path has it: nothing is called so.
    InvalidInputs
        If parameters behind the path have it.
    """
    if NUL in request.scope["path"]:
        raise HTTPException(404, "a name cannot contain U+0000")
    if b"%00" in request.scope["query_string"]:
        given = request.query_params.multi_items()
        having = [(name, value) for name, value in given if NUL in name or NUL in value]
        _refuse({name: value if NUL in value else name for name, value in having})


def may_have(part: bytes) -> bool:
    """Return whether a part of JSON may have U+0000 in a text."""
    return _ESCAPED in part


def has(body: bytes) -> bool:
    """Return whether JSON has U+0000 in a text; its time is linear in the length."""
    return _CHARACTER.search(body) is not None


def refuse_in(value: object) -> None:
    """Refuse JSON with U+0000 in a text or a name.

    Raises
    ------
    InvalidInputs
        With the fields that have it.
    """
    _refuse(dict(_places(value)))


def _refuse(texts: Mapping[str, str]) -> None:
    """Refuse fields by their names if there are any; each with the text, or the name, that has it."""
    if texts:
        raise InvalidInputs(
            [
                Fault(plain(name.replace(NUL, "\\0")), "nul", DETAIL.format(_position(text)))
                for name, text in islice(texts.items(), MOST_NAMED)
            ]
        )


def _position(text: str) -> str:
    """Return line and column of the first U+0000 in a text, as editors count."""
    before = text[: text.index(NUL)]
    line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
    return f"line {line}, column {column}" if "\n" in text else f"character {column}"


def _places(value: object) -> Iterator[tuple[str, str]]:
    """Yield the place of a U+0000 in JSON: the path with dots, and the text or name that holds it."""
    waiting: list[tuple[str, object]] = [("", value)]
    while waiting:
        place, part = waiting.pop()
        within = f"{place[:200]}." if place else ""
        if isinstance(part, str) and NUL in part:
            yield place or "body", part
        elif isinstance(part, dict):
            yield from ((f"{within}{name[:80]}", name) for name in part if NUL in name)
            waiting += [(f"{within}{name[:80]}", inner) for name, inner in part.items()]
        elif isinstance(part, list):
            waiting += [(f"{within}{number}", inner) for number, inner in enumerate(part)]
