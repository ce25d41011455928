"""Read and calculate the worksheet, and compare its values with those that Mathcad stored.

If the language refuses a line, the region of that line is refused, and regions that depend on it are blocked.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np

from app.worksheets.imports.outcome import Outcome
from app.worksheets.imports.quantities import close
from templates.core.errors import TemplateError
from templates.core.language.template import Template
from templates.core.sheets import Sheet, SheetFault, SheetRefused, read

MOST_ROUNDS = 8
FOLLOWS = "unknown_name"
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_KIND = re.compile(r"^(?:given|choice|curve) ")
_SAID = re.compile(r'"[^"\n]*"|\[[^\[\]\n]*\](?= (?:=|over|")|[,)])')


def text_of(title: str, outcomes: Iterable[Outcome]) -> str:
    """Return the text of the worksheet: its title, then the lines of the regions in page order."""
    return "\n".join(line for line, _ in _lines(title, outcomes)) + "\n"


def verified(title: str, outcomes: Sequence[Outcome]) -> str:
    """Return the faultless text of a worksheet, and compare each outcome with Mathcad's result.

    Regions whose lines the language refuses become remarks, as do regions that depend on them.
    """
    sheet = _readable(title, outcomes)
    template = _calculated(sheet) if sheet else None
    for outcome in outcomes:
        _compare(outcome, template)
    return text_of(title, outcomes)


def _readable(title: str, outcomes: Sequence[Outcome]) -> Sheet | None:
    """Return the worksheet with refused lines turned into remarks; None if that takes too many rounds."""
    gone: dict[str, str] = {}  # removed names, with the region that declared each
    for _ in range(MOST_ROUNDS):
        lines = list(_lines(title, outcomes))
        try:
            return read("\n".join(line for line, _ in lines) + "\n")
        except SheetRefused as refused:
            _take_out(refused.faults, _owners(lines), gone)
    for outcome in outcomes:
        if outcome.state == "unverified":
            outcome.refuse("worksheet that is too large", "import a part of the sheet")
    return None


def _lines(title: str, outcomes: Iterable[Outcome]) -> Iterator[tuple[str, Outcome | None]]:
    yield f"# {title}", None
    for outcome in outcomes:
        for line in outcome.lines:
            yield line, outcome


def _owners(lines: Iterable[tuple[str, Outcome | None]]) -> dict[int, Outcome]:
    """Return the outcome that owns each line, by the number of the line."""
    owners, number = dict[int, Outcome](), 1
    for line, outcome in lines:
        height = line.count("\n") + 1
        if outcome is not None:
            owners.update(dict.fromkeys(range(number, number + height), outcome))
        number += height
    return owners


def _take_out(faults: Sequence[SheetFault], owners: Mapping[int, Outcome], gone: dict[str, str]) -> None:
    """Turn faulty lines into remarks, and block lines whose only fault is a removed name."""
    for fault in sorted(faults, key=lambda fault: fault.code == FOLLOWS):
        outcome = owners.get(fault.line)
        if outcome is None or outcome.state in ("refused", "blocked"):
            continue
        names = _declared(outcome)
        lacking = [name for name in _used(outcome) if name in gone] if fault.code == FOLLOWS else []
        if lacking:
            outcome.block(lacking[0], gone[lacking[0]])
        else:
            reason = f"formula that the language refuses ({fault.message})"
            outcome.refuse(reason, fault.remedy or "write it by hand")
        gone.update(dict.fromkeys(names, outcome.original.number))
    _block_followers(owners, gone)


def _block_followers(owners: Mapping[int, Outcome], gone: dict[str, str]) -> None:
    """Block the lines that need removed names, in order, without reading the sheet again."""
    for outcome in {id(one): one for one in owners.values()}.values():
        names = _declared(outcome) if outcome.state == "unverified" else []
        lacking = [name for name in _used(outcome) if name in gone and name not in names] if names else []
        if lacking:
            outcome.block(lacking[0], gone[lacking[0]])
            gone.update(dict.fromkeys(names, outcome.original.number))


def _declared(outcome: Outcome) -> list[str]:
    """Return the names that the lines of a region declare."""
    matches = (_NAME.search(_KIND.sub("", line)) for line in outcome.lines if not line.startswith((">", "/")))
    return [match[0] for match in matches if match]


def _used(outcome: Outcome) -> Iterator[str]:
    """Yield the names in the lines of a region, without those in descriptions and in declared units."""
    for line in outcome.lines:
        if not line.startswith((">", "/")):
            yield from _NAME.findall(_SAID.sub(" ", line))


def _calculated(sheet: Sheet) -> Template | None:
    cls = sheet.template("imported", 1)
    try:
        return cls.from_quantities(cls.example)
    except TemplateError:
        return None


def _compare(outcome: Outcome, template: Template | None) -> None:
    if outcome.state != "unverified" or not outcome.name:
        return
    values = tuple(_value(template, outcome.name))
    if not all(map(math.isfinite, values)):
        outcome.state, outcome.ours = "differs", values
        outcome.notes.append("the worksheet gives no value here")
    elif outcome.cached is not None:
        outcome.ours = values
        outcome.state = "verified" if close(outcome.ours, outcome.cached.values) else "differs"


def _value(template: Template | None, name: str) -> Iterator[float]:
    """Yield a value of the worksheet in SI, item by item; NaN if missing."""
    with np.errstate(all="ignore"):
        try:
            value = getattr(template, name)
        except (TemplateError, ArithmeticError, AttributeError):
            value = math.nan
    yield from (float(item) for item in np.ravel(value))
