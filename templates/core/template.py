"""Kept for imports of version 0.1: the language, for templates written for version 0.1."""

from templates.core.language.template import (
    VERSIONED,
    Array,
    Template,
    Truth,
    choice,
    curve,
    derived,
    formula,
    given,
    profile,
    require,
    shared,
    table,
    text,
    units,
)

__all__ = [
    "VERSIONED",
    "Array",
    "Template",
    "Truth",
    "choice",
    "curve",
    "derived",
    "formula",
    "given",
    "profile",
    "require",
    "shared",
    "table",
    "text",
    "units",
]
