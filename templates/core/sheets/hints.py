"""Remedies for a statement that cannot be parsed, chosen by the offending character or the missing part."""

from __future__ import annotations

import re
from collections.abc import Collection

_SIGNS = (  # the text before, the text at the fault, and the correct form
    ("", r"\^", "a power is written `**`, for example `D**2`"),
    (r"\d", r",\d", "decimals take a point, for example `2.5`"),
    ("", r":=", "write `=`, without a colon"),
    (r"\d", r"[A-Za-zµ°%]", "put a blank between a number and its unit, for example `25 kN`"),
    ("", r"<>|=<|=>|≤|≥|≠", "a comparison is one of < <= > >= == !="),
    ("", r"×|·|÷", "operators are + - * / **"),
)
_MISSING = {  # the expected terminal, and how it is written
    "UNIT": "the unit is missing here: write it in brackets, such as `[kN]`, or `[1]` for a pure number",
    "KEY": (
        "clauses are `> 0`, `<= 2 m`, `published 1 to 2`, `example 3 mm`, "
        '`source "…"`, `remedy "…"`, `also "…"`'
    ),
    "FROM": (
        "write bounds, such as `from 1 mm to 2 m`; "
        'with several unknowns write words for each, such as `"width"`'
    ),
    "TEXT": 'words between quotation marks are missing here, such as `"bearing diameter"`',
    "ELSE": "every `if` needs an `else`",
    "THEN": "write `then` after the condition of `if`",
    "WITHIN": "write a tolerance, such as `within 0.2 %`",
}
_FORMULA = 'p [MPa] = F / (D * B) "projected pressure"'
_FORMS = {
    "given": 'given D [mm] "bearing diameter" (> 0; example 48 mm)',
    "choice": 'choice law = walther "viscosity law" (walther | vogel)',
    "curve": 'curve mu(T [degC]) [mPa*s] "viscosity": 40 -> 80 100 -> 9',
    "solve": 'solve x [mm] from 1 mm to 2 m so that F / x**2 == 10 MPa "width"',
    "require": 'require B <= D "The bush is not longer than wide"',
    "check": 'check p <= 30 MPa "white metal carries it"',
    "test": 'test "by hand" with F = 25 kN gives p = 21.7 MPa within 0.2 %',
}


def remedy_of(statement: str, before: str, there: str, expected: Collection[str]) -> str:
    """Return a remedy for a statement that cannot be parsed.

    Parameters
    ----------
    statement
        The text of the statement.
    before, there
        The text of the line before the fault, and from the fault onwards.
    expected
        The terminals of the grammar that are possible there.
    """
    word = statement.split(maxsplit=1)[0]
    if word not in _FORMS and word.lower() in _FORMS:
        return f"write {word.lower()} in small letters"
    for last, first, remedy in _SIGNS:
        if re.match(first, there) and re.search(f"(?:{last})$", before):
            return remedy
    for terminal, remedy in _MISSING.items():
        if terminal in expected:
            return remedy
    return f"write it like `{_FORMS.get(word, _FORMULA)}`"
