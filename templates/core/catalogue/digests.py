"""The digest of a version, which shows whether its code has changed since its release.

A released version is a file that nobody edits. Its digest is the SHA-256 of the syntax tree without the
module paths of imports; the imported names are included. A module that a released file imports may therefore
move to another folder, and the import statement may be updated. The digest ignores docstrings, comments,
layout and the attributes in `MARKS`, because they do not affect results. It includes the files of groups,
which give a template inputs, formulas or rules, and of functions that return a rule for several models.

A worksheet computes its own digest.
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

from templates.core.catalogue.modules import text_of
from templates.core.language.origin import file_of
from templates.core.language.spec import Declaration, Requirement, Shared
from templates.core.language.syntax_trees import parse
from templates.core.language.template import Template

MARKS = frozenset({"withdrawn", "criteria", "assumptions", "main_results", "toleranced", "sections"})
"""Class attributes that a released version may change."""

_MOST_KEPT = 256  # digests to cache, keyed by the source text; every page shows them
_SILENT = frozenset(
    {"ctx", "kind", "type_comment"}
)  # fields that repeat information from elsewhere in the tree


def digest(cls: type[Template]) -> str:
    """Return the digest of a version, computed from its current file."""
    return cls.sheet.digest() if cls.sheet else digest_of(_sources(cls))


def digest_of(sources: Iterable[str]) -> str:
    """Return the digest of the source of a template and of its groups."""
    return _digest_of(tuple(sources))


@lru_cache(_MOST_KEPT)
def _digest_of(sources: tuple[str, ...]) -> str:
    text = "\n".join(dict.fromkeys(_content(parse(source)) for source in sources))
    return hashlib.sha256(text.encode()).hexdigest()


def release_file(cls: type[Template]) -> Path | None:
    """Return the path of the digest file of a released version, next to its source; None for a worksheet."""
    path = file_of(cls)
    return path and path.with_name(f"{path.stem}.release.json")


def _sources(cls: type[Template]) -> Iterator[str]:
    """Yield the source of the template, of its groups, and of the modules that return its shared rules."""
    groups = [base for base in cls.__mro__ if base is cls or _declares(base)]
    for owner in (*groups, *(rule.function for rule in cls.requirements)):
        module = inspect.getmodule(owner)
        assert module is not None
        yield text_of(module) or inspect.getsource(module)


def _declares(base: type) -> bool:
    """Return whether a base class declares anything itself; the base classes of the language do not."""
    return any(isinstance(value, (Declaration, Requirement, Shared)) for value in vars(base).values())


def _content(tree: ast.Module) -> str:
    """Return the part of a file that affects results, as text: the imported names, then the syntax tree.

    The tree is serialised field by field, because `ast.unparse` and `ast.dump` differ between Python
    versions.
    """
    names = sorted({name for node in ast.walk(tree) if _is_import(node) for name in _imported(node)})
    return json.dumps([names, _plain(tree)], separators=(",", ":"))


def _is_import(node: ast.AST) -> bool:
    return isinstance(node, (ast.Import, ast.ImportFrom))


def _imported(node: Any) -> Iterator[tuple[str, str]]:
    """Yield each imported name without its module path, together with the name used in the file."""
    for alias in node.names:
        name = alias.name.rpartition(".")[2]
        yield name, alias.asname or name


def _plain(value: Any, within_class: bool = False) -> Any:
    """Return a part of a syntax tree as JSON, without empty fields."""
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
    """Return whether a statement is a docstring or another string that has no effect."""
    constant = node.value if isinstance(node, ast.Expr) else None
    return isinstance(constant, ast.Constant) and isinstance(constant.value, str)


def _is_mark(node: Any) -> bool:
    """Return whether a statement of a class sets one of the attributes in `MARKS`."""
    targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
    names = {target.id if isinstance(target, ast.Name) else "" for target in targets}
    return isinstance(node, (ast.Assign, ast.AnnAssign)) and names <= MARKS
