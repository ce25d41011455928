"""Translate the regions of a sheet into the lines of a worksheet, region by region."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from app.worksheets.imports.definitions import Definitions
from app.worksheets.imports.errors import Unnamed, Untranslatable
from app.worksheets.imports.names import key_of, look
from app.worksheets.imports.outcome import Outcome, one_line
from app.worksheets.imports.regions import OriginalSheet
from app.worksheets.imports.trees import Node

_SHOWN = {"plot": "plot", "picture": "picture", "page break": "page break", "area": "area",
          "solve block": "solve block", "other": "control"}  # fmt: skip
LONGEST_PROSE = 1_000


def translated(sheet: OriginalSheet) -> list[Outcome]:
    """Return the outcome of every region, before its values are compared with Mathcad's."""
    work = Definitions(sheet)
    outcomes = [Outcome(region) for region in sheet.regions]
    work.outcomes = {id(outcome.original): outcome for outcome in outcomes}
    early = [o for o in outcomes if o.original.math is not None and o.original.math.tag == "globalDefine"]
    for outcome in (*early, *(o for o in outcomes if o not in early)):
        _one(outcome, work)
    work.finish()
    return outcomes


def _one(outcome: Outcome, work: Definitions) -> None:
    region = outcome.original
    if region.kind == "text":
        outcome.show("text")
        outcome.lines = _prose(region.text)
    elif region.math is None:
        outcome.show(_SHOWN.get(region.kind, region.kind))
    elif region.role:
        _solving(outcome, work)
    else:
        _calculating(outcome, work)


def _calculating(outcome: Outcome, work: Definitions) -> None:
    region = outcome.original
    assert region.math is not None
    try:
        work.take(outcome, region.math)
    except Untranslatable as error:
        outcome.refuse(error.construct, error.remedy)
    except Unnamed as error:
        if error.region is not None:
            outcome.block(look(error.name), str(error.region))
        else:
            what = f"name {one_line(look(error.name))} that nothing above defines"
            outcome.refuse(what, "define it, or replace it")
    except RecursionError:
        outcome.refuse("formula that nests too deep", "split it into several")
    if outcome.state in ("refused", "blocked"):
        work.fail(region.math, region.number)


def _solving(outcome: Outcome, work: Definitions) -> None:
    """Translate a region of a solve block; only the region with the solver defines names."""
    region = outcome.original
    assert region.math is not None
    if region.role != "solver":
        outcome.show(f"{region.role.replace('-', ' ')} of a solve block")
        return
    unknowns = [key_of(node) for node in _sought(region.math)]
    if len(unknowns) == 1:
        equation = next((c for c in work.in_block(region) if c.original.role == "constraint"), None)
        condition = work.equation(equation.original) if equation else "left == right"
        name = look(unknowns[0])
        remedy = f"give it bounds, for example `solve {name} [1] from 0 to 1 so that {condition}`"
        outcome.refuse("solve block, whose unknown has a guess and no bounds", remedy)
    else:
        outcome.refuse(
            f"solve block of {len(unknowns)} unknowns", "solve for one unknown, or calculate elsewhere"
        )
    work.fail(region.math, region.number)


def _sought(math: Node) -> list[Node]:
    for call in math.all("apply"):
        if call.parts and call.parts[0].tag == "id" and key_of(call.parts[0]).lower() in ("find", "minerr"):
            arguments = call.parts[1:]
            return list(arguments[0].parts) if arguments[0].tag == "sequence" else arguments
    return []


def _prose(text: str) -> list[str]:
    lines: Iterable[str] = (one_line(line) for line in text[: LONGEST_PROSE * 10].splitlines())
    kept: Sequence[str] = [line[:LONGEST_PROSE] for line in lines if line]
    return [f"> {line}" for line in kept[:50]]
