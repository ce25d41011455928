"""Mutants that somebody thought of: each is a text that occurs once in the code, and another in its place.

They stand under `[[named]]` in `.ci/mutants.toml`, found by their text, so that files may move.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from pathlib import Path

from benchmarks.mutation import ROOT
from benchmarks.mutation.places import Mutant, difference, digest, is_another


def named(file: Path) -> list[Mutant]:
    """Return the mutants on file.

    Raises
    ------
    LookupError
        If the text of one occurs not once: then the entry has to follow the code.
    """
    entries = tomllib.loads(file.read_text(encoding="utf-8")).get("named", [])
    return [_mutant(entry["title"], entry["before"], entry["after"]) for entry in entries]


def _mutant(title: str, before: str, after: str) -> Mutant:
    matching = [(path, text) for path, text in _sources() if before in text]
    if len(matching) != 1 or matching[0][1].count(before) != 1:
        raise LookupError(f"{title}: its text occurs in {[path for path, _ in matching]}, not once")
    path, text = matching[0]
    mutated = text.replace(before, after)
    if not is_another(text, mutated):
        raise LookupError(f"{title}: the change is no other program")
    line = text[: text.index(before)].count("\n") + 1
    return Mutant(digest(title)[:12], path, line, title, "named", mutated, difference(text, mutated))


def _sources() -> Iterator[tuple[str, str]]:
    for folder in ("app", "cad", "templates"):
        for path in sorted((ROOT / folder).rglob("*.py")):
            yield path.relative_to(ROOT).as_posix(), path.read_text(encoding="utf-8")
