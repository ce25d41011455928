"""Write, scan and parse the strings and tokens of ISO 10303-21, the clear text encoding of STEP files.

A client may send any bytes as a STEP file. The scan reads the text once and never goes back, so its time is
linear in the length of the text, whatever the text contains.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import AnyStr

_BLANK, _WORD = re.compile(r"\s+"), re.compile(r"[A-Za-z0-9_]+")
_NUMBER, _NUMBER_OF_BYTES = re.compile(r"#\d+"), re.compile(rb"#\d+")
_ESCAPED = re.compile(r"''|\\\\|\\X(2|4)\\((?:[0-9A-F]{4})*)\\X0\\")
_ENDING = re.compile(r"'(?=\s*[,)])")
_QUOTE = "\\X2\\0027\\X0\\"
_BEYOND_ASCII = re.compile(r"[^\x00-\x7f]+")
_NOT_PLAIN = re.compile(r"[^ -~\U00010000-\U0010ffff]+|[\U00010000-\U0010ffff]+")


def quoted(text: str) -> str:
    r"""Return a text as a string of Part 21: quotes and backslashes doubled, non-ASCII as `\X2\…\X0\`.

    Characters outside the basic multilingual plane, such as emoji, become `\X4\…\X0\`. Open CASCADE takes a
    quote before a comma or bracket for the end of the string, even if it is doubled, so such a quote is
    written as its character code.
    """
    escaped = _QUOTE.join(_ENDING.split(text.replace("\\", "\\\\")))
    return "'" + _NOT_PLAIN.sub(_escaped, escaped.replace("'", "''")) + "'"


def _escaped(signs: re.Match[str]) -> str:
    form, encoding = ("X2", "utf-16-be") if signs[0][0] < "\U00010000" else ("X4", "utf-32-be")
    return f"\\{form}\\{signs[0].encode(encoding).hex().upper()}\\X0\\"


def in_ascii(text: str) -> str:
    r"""Return a text from Open CASCADE, whose bytes are UTF-8, with non-ASCII characters as `\X2\…\X0\`."""
    return _BEYOND_ASCII.sub(
        lambda run: _NOT_PLAIN.sub(_escaped, run[0].encode("latin-1").decode("utf-8", "replace")), text
    )


def plain(string: str) -> str:
    """Return the content of a Part 21 string, given with its quotes.

    Line breaks within the string are not part of its content.
    """
    return _ESCAPED.sub(_unescaped, string[1:-1].replace("\n", "").replace("\r", ""))


def _unescaped(escape: re.Match[str]) -> str:
    if escape[1] is None:
        return escape[0][0]
    encoding = "utf-16-be" if escape[1] == "2" else "utf-32-be"
    return bytes.fromhex(escape[2]).decode(encoding, "replace")


def entities(text: AnyStr, pattern: re.Pattern[AnyStr]) -> Iterator[re.Match[AnyStr]]:
    """Yield the matches of a pattern that are entities, each at the beginning of a line.

    The pattern begins with ` = KEYWORD`: a search for these letters takes a tenth of the time of one for
    `^#[0-9]+`.
    """
    line_end, number = ("\n", _NUMBER) if isinstance(text, str) else (b"\n", _NUMBER_OF_BYTES)
    for match in pattern.finditer(text):
        if number.fullmatch(text, text.rfind(line_end, 0, match.start()) + 1, match.start()):
            yield match


def description(text: str) -> list[str]:
    """Return the strings of the first list of FILE_DESCRIPTION, each with its quotes.

    Return None if there is no such list. The search stops at the end of the header section.
    """
    scan = tokens(text)
    for token in scan:
        if token == "ENDSEC":
            break
        if token == "FILE_DESCRIPTION" and next(scan, "") == "(" and next(scan, "") == "(":
            return _strings(scan)
    return []


def _strings(scan: Iterator[str]) -> list[str]:
    """Return the strings up to the closing bracket.

    Return None if anything other than strings and commas precedes the bracket.
    """
    strings: list[str] = []
    for token in scan:
        if token == ")":
            return strings
        if token.startswith("'"):
            strings.append(token)
        elif token != ",":
            break
    return []


def tokens(text: str) -> Iterator[str]:
    """Yield words, single characters, and strings with their quotes; skip blanks and comments.

    A string or comment without an end extends to the end of the text.
    """
    place = 0
    while place < len(text):
        start, place = place, _end(text, place)
        if not (text[start].isspace() or text.startswith("/*", start)):
            yield text[start:place]


def _end(text: str, start: int) -> int:
    """Return the end of the token, blank or comment that begins at `start`."""
    if text[start] == "'":
        return end_of_string(text, start)
    if text.startswith("/*", start):
        return _behind(text, "*/", start + 2)
    match = _BLANK.match(text, start) or _WORD.match(text, start)
    return match.end() if match else start + 1


def end_of_string(text: str, start: int) -> int:
    """Return the position after the quote that closes a string; a doubled quote is part of the string."""
    place = _behind(text, "'", start + 1)
    while text.startswith("'", place):
        place = _behind(text, "'", place + 1)
    return place


def _behind(text: str, mark: str, start: int) -> int:
    """Return the position after the next `mark`, or the end of the text if there is none."""
    place = text.find(mark, start)
    return len(text) if place < 0 else place + len(mark)
