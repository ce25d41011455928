"""Digests of a version: two answers to the question whether its code is still that of the release.

A released version is a file that nobody edits, so its code is hashed. There are two kinds of digest:

`digest` (kind 1)
    SHA-256 of the file as Python writes it, import lines included. Revisions and reports of version 0.1 quote
    it, so it is kept: a released version quotes the digest that was recorded at its release.
`content_digest` (kind 2, `DIGEST_VERSION`)
    SHA-256 of the syntax tree without the module paths of imports; the imported names stay. A module that a
    released file imports may move to another folder, and the import line may follow it.

Neither sees docstrings, comments, layout and what `MARKS` names: they calculate nothing. The files of groups,
which give a template inputs, formulas or rules, are part of both.

Of a worksheet all are one: the digest that the worksheet itself gives.
"""

from __future__ import annotations

import ast
import hashlib
import inspect
import json
from collections.abc import Iterable, Iterator
from functools import lru_cache
from pathlib import Path
from typing import Any

from templates.core.catalogue.loading import text_of
from templates.core.language.origin import file_of
from templates.core.language.parsing import parse
from templates.core.language.spec import Declaration, Requirement, Shared
from templates.core.language.template import Template

DIGEST_VERSION = 2

MARKS = frozenset({"withdrawn", "criteria", "toleranced", "sections"})
"""Class attributes that a released version may change."""

_FIRST_MARKS = MARKS | {"film_bore"}
_MOST_KEPT = 256  # versions whose digests are kept, by the text of their files: every page quotes both
_SILENT = frozenset({"ctx", "kind", "type_comment"})  # fields that repeat what stands elsewhere in the tree


def digest(cls: type[Template]) -> str:
    """The first digest: as recorded at the release, else computed.

    The record counts only as long as the code is that of the release: an edited file has another digest.
    """
    if cls.sheet:
        return cls.sheet.digest()
    recorded = _released(cls)
    return recorded["digest"] if recorded else source_digest(cls)


def source_digest(cls: type[Template]) -> str:
    """The first digest, computed from the file as it stands, import lines included."""
    if cls.sheet:
        return cls.sheet.digest()
    return _source_digest_of(tuple(_sources(cls)))


def content_digest(cls: type[Template]) -> str:
    """The second digest, computed from the file as it stands."""
    if cls.sheet:
        return cls.sheet.digest()
    return content_digest_of(_sources(cls))


def content_digest_of(sources: Iterable[str]) -> str:
    """The second digest of the text of files: that of a template, then those of its groups."""
    return _content_digest_of(tuple(sources))


@lru_cache(_MOST_KEPT)
def _content_digest_of(sources: tuple[str, ...]) -> str:
    return _sha256("\n".join(dict.fromkeys(_content(parse(source)) for source in sources)))


@lru_cache(_MOST_KEPT)
def _source_digest_of(sources: tuple[str, ...]) -> str:
    return _sha256("\n".join(dict.fromkeys(_bare(source) for source in sources)))


def is_digest_of(text: str, cls: type[Template]) -> bool:
    """True if a digest of either kind, from an old revision say, belongs to the code of this version."""
    return text in (digest(cls), content_digest(cls), source_digest(cls))


def release_file(cls: type[Template]) -> Path | None:
    """The file of the digests of a released version, beside its own file; None of a worksheet."""
    path = file_of(cls)
    return path and path.with_name(f"{path.stem}.release.json")


def digests(cls: type[Template]) -> dict[str, Any]:
    """Both digests and the kind of the second, as records of a release hold them."""
    return {"digest": digest(cls), "digest_version": DIGEST_VERSION, "content_digest": content_digest(cls)}


def _released(cls: type[Template]) -> dict[str, Any] | None:
    """The recorded digests, if there are any and the code is still the released one."""
    path = release_file(cls)
    if path is None or not path.exists():
        return None
    recorded: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return recorded if recorded.get("content_digest") == content_digest(cls) else None


def _sources(cls: type[Template]) -> Iterator[str]:
    """The text of the template's file, then of the files of its groups."""
    for base in cls.__mro__:
        if base is cls or _declares(base):
            module = inspect.getmodule(base)
            assert module is not None
            yield text_of(module) or inspect.getsource(module)


def _declares(base: type) -> bool:
    """Return whether a base declares anything of its own; the bases that are the language do not."""
    return any(isinstance(value, (Declaration, Requirement, Shared)) for value in vars(base).values())


def _sha256(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def _bare(source: str) -> str:
    """A file as far as it calculates, for the first digest."""
    return ast.unparse(_Bare().visit(parse(source)))


class _Bare(ast.NodeTransformer):
    """Removes what does not calculate."""

    def visit_Expr(self, node: ast.Expr) -> ast.AST | None:
        return None if _is_text(node) else node

    def visit_Assign(self, node: ast.Assign) -> ast.AST | None:
        return None if {ast.unparse(target) for target in node.targets} <= _FIRST_MARKS else node

    def visit_AnnAssign(self, node: ast.AnnAssign) -> ast.AST | None:
        return None if ast.unparse(node.target) in _FIRST_MARKS else node


def _content(tree: ast.Module) -> str:
    """A file as far as it calculates, for the second digest: imported names, then the syntax tree.

    Written field by field, because `ast.unparse` and `ast.dump` differ between versions of Python.
    """
    names = sorted({name for node in ast.walk(tree) if _is_import(node) for name in _imported(node)})
    return json.dumps([names, _plain(tree)], separators=(",", ":"))


def _is_import(node: ast.AST) -> bool:
    return isinstance(node, (ast.Import, ast.ImportFrom))


def _imported(node: Any) -> Iterator[tuple[str, str]]:
    """Yield each name that an import imports, without its module's path, and its name in the file."""
    for alias in node.names:
        name = alias.name.rpartition(".")[2]
        yield name, alias.asname or name


def _plain(value: Any, within_class: bool = False) -> Any:
    """A part of a syntax tree as JSON; empty fields are left out."""
    if isinstance(value, ast.AST):
        is_class = isinstance(value, ast.ClassDef)
        fields = {k: _plain(v, is_class) for k, v in ast.iter_fields(value) if k not in _SILENT}
        return [type(value).__name__, {k: v for k, v in sorted(fields.items()) if v not in (None, [])}]
    if isinstance(value, list):
        return [_plain(item) for item in value if not _is_silent(item, within_class)]
    return value if value is None or isinstance(value, str) else [type(value).__name__, repr(value)]


def _is_silent(node: Any, within_class: bool) -> bool:
    return _is_import(node) or _is_text(node) or (within_class and _is_mark(node))


def _is_text(node: Any) -> bool:
    """Return whether a statement is a docstring, or another text that does nothing."""
    constant = node.value if isinstance(node, ast.Expr) else None
    return isinstance(constant, ast.Constant) and isinstance(constant.value, str)


def _is_mark(node: Any) -> bool:
    """Return whether a statement of a class sets one of its marks."""
    targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
    names = {target.id if isinstance(target, ast.Name) else "" for target in targets}
    return isinstance(node, (ast.Assign, ast.AnnAssign)) and names <= MARKS
