"""A worksheet: text that was read and checked as a whole, and its template class."""

from __future__ import annotations

import copyreg
import hashlib
import json
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import Any

from templates.core.language.spec import Derived, Formula, Profile
from templates.core.language.template import Template
from templates.core.sheets.class_builder import Builder
from templates.core.sheets.classes import SheetClass, class_of
from templates.core.sheets.contents import Built
from templates.core.sheets.depths import set_order
from templates.core.sheets.design_lines import Plot
from templates.core.sheets.design_names import DesignName
from templates.core.sheets.faults import SheetRefused
from templates.core.sheets.grammar import LANGUAGE
from templates.core.sheets.lines import Chunk, chunks_of, normal
from templates.core.sheets.loops import faults_of_loops
from templates.core.sheets.names import KnownName
from templates.core.sheets.paper import latex_of
from templates.core.sheets.prose import documentation_of, markdown_of, title_of
from templates.core.sheets.worksheet_tests import SheetTest

_ID = re.compile(r"[a-z][a-z0-9_]*")


@dataclass(frozen=True)
class Statement:
    """A statement as an editor shows it.

    Attributes
    ----------
    kind
        given, choice, curve, formula, function, solve, require, check, test, plot, prose or remark.
    name
        The attribute of the class: a symbol, or the name of a rule; for a check, the name of its criterion.
    words
        The text of the statement: the words of a quantity, the sentence of a rule, the Markdown of prose.
    latex
        The printed line; empty if it has no formula.
    """

    kind: str
    name: str
    line: int
    last_line: int
    words: str
    latex: str = ""


@dataclass(frozen=True)
class Sheet:
    """A worksheet without faults."""

    text: str
    chunks: tuple[Chunk, ...] = field(repr=False)
    built: Built = field(repr=False, compare=False)
    language: int = LANGUAGE
    design: tuple[DesignName, ...] | None = None  # the values that the worksheet of a design may use

    @property
    def title(self) -> str:
        """Return the first heading; empty if there is none."""
        return title_of(self.chunks)

    @property
    def tests(self) -> tuple[SheetTest, ...]:
        """Return the tests of the worksheet; `run_tests` runs them."""
        return tuple(self.built.tests)

    @cached_property
    def names(self) -> tuple[KnownName, ...]:
        """Return the names that formulas may use, for completion in an editor."""
        return tuple(self.built.named.values())

    @cached_property
    def used(self) -> tuple[DesignName, ...]:
        """Return the values of the design that the lines use."""
        return tuple(one for one in self.design or () if one.attribute in self.built.parts)

    @property
    def is_exact(self) -> bool:
        """Return whether its results have no error of their own, as those of a design's lines."""
        return self.design is not None

    @property
    def plots(self) -> tuple[Plot, ...]:
        """Return the plots, in the order of the lines."""
        return tuple(self.built.plots)

    def digest(self) -> str:
        """Return the SHA-256 of the statements and the language version, without prose and layout."""
        return self._digest

    @cached_property
    def _digest(self) -> str:
        statements = [statement.words for statement in self.built.statements]
        used = [[one.name, one.unit] for one in self.used]
        content = json.dumps([self.language, statements, *used], separators=(",", ":"))
        return hashlib.sha256(content.encode()).hexdigest()

    @cached_property
    def statements(self) -> tuple[Statement, ...]:
        """Return every statement, including prose and remarks, in the order of the lines."""
        lines = {statement.chunk.line: statement for statement in self.built.statements}
        written = latex_of(self.template("worksheet", 1), self.built)
        return tuple(self._statement(chunk, lines.get(chunk.line), written) for chunk in self.chunks)

    def _statement(self, chunk: Chunk, parsed: Any, written: dict[int, str]) -> Statement:
        if parsed is None:
            words = markdown_of(chunk)
            return Statement(chunk.kind, "", chunk.line, chunk.last_line, words)
        name, words = self.built.called.get(chunk.line, ""), self.built.said.get(chunk.line, "")
        kind = "solve" if parsed.kind == "system" else parsed.kind
        return Statement(kind, name, chunk.line, chunk.last_line, words, written.get(chunk.line, ""))

    def template(self, id: str, version: int) -> type[Template]:
        """Return the class of the worksheet under an id and version.

        Raises
        ------
        ValueError
            If the id is not a name in snake_case, or the version is below 1.
        """
        if not _ID.fullmatch(id) or version < 1:
            raise ValueError(
                f"the id {id!r} must be in snake_case, and the version {version!r} must be at least 1"
            )
        parts: dict[str, Any] = {
            "__doc__": documentation_of(self.chunks) or id.replace("_", " ").capitalize(),
            "example": self.built.example,
            "criteria": self.built.criteria,
            **self.built.declarations(),
        }
        if self.design is not None:
            parts["main_results"] = self._single_results()
        return class_of(self, id, version, parts)

    def _single_results(self) -> tuple[str, ...]:
        """Return the names of the results that are single values, which a table of results shows."""
        results = (one for one in self.built.parts.values() if isinstance(one, Formula))
        return tuple(one.name for one in results if not isinstance(one, (Derived, Profile)))


def read(text: str, design: tuple[DesignName, ...] | None = None) -> Sheet:
    """Return a worksheet from its text; `design` are the values that the worksheet of a design may use.

    Raises
    ------
    SheetRefused
        If the text has faults. The error lists all of them, each with line and column, a code, a sentence and
        a remedy.
    """
    text = normal(text)
    chunks = chunks_of(text)
    built = Builder([chunk for chunk in chunks if not chunk.kind], design).built
    if faults := [*built.faults, *faults_of_loops(built)] or [*set_order(built)]:
        raise SheetRefused(faults)
    return Sheet(text, tuple(chunks), built, design=design)


@lru_cache(maxsize=64)
def from_text(
    text: str,
    id: str,
    version: int,
    withdrawn: str | None = None,
    design: tuple[DesignName, ...] | None = None,
) -> type[Template]:
    """Return the class of a worksheet, cached by its arguments in this process.

    Raises
    ------
    SheetRefused
        If the text has faults.
    """
    cls = read(text, design).template(id, version)
    cls.withdrawn = withdrawn
    return cls


def _reduced(cls: Any) -> tuple[Callable[..., Any], tuple[Any, ...]]:
    return from_text, (cls.sheet.text, cls.id, cls.version, cls.withdrawn, cls.sheet.design)


copyreg.pickle(SheetClass, _reduced)
