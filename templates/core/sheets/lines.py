"""Split the text of a worksheet into statements; an indented line continues one, `#` and `>` begin prose."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from templates.core.errors import excerpt
from templates.core.sheets.faults import SheetFault, SheetRefused

MOST_BYTES = 64 * 1024
MOST_STATEMENTS = 400
LONGEST_STATEMENT = 2000
_CONTROLS = frozenset("\x7f\x85\u2028\u2029\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")
"""Characters that end a line, or change the direction of the text."""


@dataclass(frozen=True)
class Chunk:
    """One statement as written: its first line number, and its text including line ends."""

    line: int
    text: str
    kind: str = ""  # `prose` or `remark`; otherwise the grammar determines it

    @property
    def last_line(self) -> int:
        """Return the last line of the statement."""
        return self.line + self.text.count("\n")


def normal(text: str) -> str:
    """Return a text without a byte order mark and with uniform line ends."""
    return text.removeprefix("\ufeff").replace("\r\n", "\n")


def chunks_of(text: str) -> list[Chunk]:
    """Return the statements of a text, including prose and remarks, in the order of its lines.

    Raises
    ------
    SheetRefused
        If the text is too large, or contains characters that are not text.
    """
    if faults := list(_faults_of_text(text)):
        raise SheetRefused(faults)
    chunks: list[Chunk] = []
    for number, line in enumerate(text.split("\n"), 1):
        before = chunks[-1] if chunks and chunks[-1].last_line == number - 1 else None
        if line[:1] in (" ", "\t") and line.strip() and before and not before.kind:
            chunks[-1] = Chunk(before.line, f"{before.text}\n{line}")
        elif line.startswith(">") and before and before.kind == "prose" and before.text.startswith(">"):
            chunks[-1] = Chunk(before.line, f"{before.text}\n{line}", "prose")
        elif line.strip():
            chunks.append(Chunk(number, line, _kind(line)))
    if faults := list(_faults_of_size(chunks)):
        raise SheetRefused(faults)
    return chunks


def _kind(line: str) -> str:
    return "prose" if line.startswith(("#", ">")) else "remark" if line.startswith("//") else ""


def _faults_of_text(text: str) -> Iterator[SheetFault]:
    if len(text) > MOST_BYTES or len(text.encode("utf-8", "replace")) > MOST_BYTES:
        message = f"a worksheet may be at most {MOST_BYTES // 1024} KiB in size"
        yield SheetFault(1, 1, "too_large", message, remedy="make two worksheets of it")
        return
    for number, line in enumerate(text.split("\n"), 1):
        column = next((place for place, sign in enumerate(line, 1) if _is_no_text(sign)), None)
        if column is not None:
            message = f"{excerpt(line[column - 1])} is not a letter, digit or sign that a text may hold"
            yield SheetFault(number, column, "syntax", message, column + 1, "take it away")


def _is_no_text(sign: str) -> bool:
    """Return whether a character is not text: a lone surrogate, a control character, or a direction mark."""
    return "\ud800" <= sign <= "\udfff" or (sign < " " and sign != "\t") or sign in _CONTROLS


def _faults_of_size(chunks: list[Chunk]) -> Iterator[SheetFault]:
    statements = [chunk for chunk in chunks if not chunk.kind]
    if len(statements) > MOST_STATEMENTS:
        message = f"a worksheet may have at most {MOST_STATEMENTS} statements"
        line = statements[MOST_STATEMENTS].line
        yield SheetFault(line, 1, "too_large", message, remedy="make two worksheets of it")
    for chunk in statements:
        if len(chunk.text) > LONGEST_STATEMENT:
            message = f"a statement may have at most {LONGEST_STATEMENT} characters"
            yield SheetFault(
                chunk.line, 1, "too_large", message, remedy="define its parts under names of their own"
            )
