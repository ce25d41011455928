"""Replies of tools: numbers with unit, error, source and verdict; at most 2 kB, and a link to the rest."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

import mcp_types as mcp
from pydantic import BaseModel

from app.calculations.schemas.evaluations import Results
from app.schemas.answers import Measured, Quantity
from app.schemas.criteria import Criterion
from app.solids.schemas.analyses import AnalysisOutput
from templates.core.errors import plain

SCHEME = "crankwright://"
LONGEST = 1850  # bytes of a result; the protocol adds its own, and 2000 is what an answer may take
LONGEST_SUMMARY = 400  # characters
LONGEST_SOURCE = 60
_DIGITS = 6

Plain = float | str | bool | None


class Number(BaseModel):
    """A number as every tool shows it; `error` is relative, and null if unknown."""

    name: str
    value: Plain
    unit: str | None
    error: float | None
    source: str
    verdict: str

    def line(self) -> str:
        """Return the number as a line of text."""
        error = "unknown" if self.error is None else f"{self.error:g}"
        return f"{self.name} = {self.value}{_unit(self.unit)}; error {error}; {self.source}; {self.verdict}"


class Item(BaseModel):
    """A template, model, design, input or file that a tool names."""

    name: str
    text: str

    def line(self) -> str:
        """Return the item as a line of text."""
        return f"{self.name}: {self.text}"


class Reply(BaseModel):
    """The answer of a tool; `rest` is the resource with everything that it leaves out."""

    summary: str
    numbers: list[Number] = []
    items: list[Item] = []
    rest: str

    @classmethod
    def output_schema(cls) -> dict[str, object]:
        """Return the JSON Schema of every reply, as short as it can be."""
        numbers, items = _listed(Number), _listed(Item)
        parts = {"summary": _TEXT, "rest": _TEXT, "numbers": numbers, "items": items}
        return {"type": "object", "properties": parts, "required": ["summary", "rest"]}

    def result(self) -> mcp.CallToolResult:
        """Return the reply as a result of at most `LONGEST` bytes; it omits the end of its longest list."""
        numbers, items = [*self.numbers], [*self.items]
        while _size(result := self._result(numbers, items)) > LONGEST and (numbers or items):
            (numbers if len(numbers) >= len(items) else items).pop()
        return result

    def _result(self, numbers: list[Number], items: list[Item]) -> mcp.CallToolResult:
        left = len(self.numbers) + len(self.items) - len(numbers) - len(items)
        summary = shortened(self.summary, LONGEST_SUMMARY) + (f" ({left} more in rest)" if left else "")
        shown = Reply(summary=summary, numbers=numbers, items=items, rest=self.rest)
        listed = [*(one.line() for one in numbers), *(one.line() for one in items)]
        return mcp.CallToolResult(
            content=[mcp.TextContent(text="\n".join([summary, *listed, f"rest: {self.rest}"]))],
            structured_content=shown.model_dump(mode="json", exclude_defaults=True),
        )


_TEXT = {"type": "string"}


def _listed(model: type[BaseModel]) -> dict[str, object]:
    return {"type": "array", "items": {"type": "object", "required": [*model.model_fields]}}


def shortened(text: str, most: int) -> str:
    """Return a text of at most `most` characters, valid in JSON; an ellipsis marks what is missing."""
    return plain(text, most) if len(text) <= most else f"{plain(text, most - 1)}…"


def refusal(text: str) -> mcp.CallToolResult:
    """Return a result that is marked as an error, with the reason and the remedy."""
    while len(text.encode()) > LONGEST - 100:
        text = text[: len(text) * 9 // 10] + " …"
    return mcp.CallToolResult(content=[mcp.TextContent(text=text)], is_error=True)


def numbers_of(
    outputs: Mapping[str, Measured | AnalysisOutput],
    error: Mapping[str, object],
    criteria: Sequence[Criterion],
    source: str,
    wanted: Sequence[str] = (),
) -> list[Number]:
    """Return the wanted outputs, then the criteria, worst first, then all other outputs."""
    shown = {
        name: of_value(
            name,
            getattr(output, "value", None),
            getattr(output, "unit", None),
            _largest(error.get(name)),
            source,
            _verdict_of(name, criteria),
        )
        for name, output in outputs.items()
    }
    first = [shown[name] for name in wanted if name in shown]
    others = [number for name, number in shown.items() if name not in wanted and number.value is not None]
    return [*first, *judged(criteria, source), *others]


def of_results(results: Results, wanted: Sequence[str]) -> list[Number]:
    """Return the numbers of an evaluation."""
    template = results.template
    source = f"{template.id} {template.version}" + (f", {results.level}" if results.level else "")
    return numbers_of(results.outputs, results.error, results.criteria or [], source, wanted)


def judged(criteria: Iterable[Criterion], source: str = "criterion") -> list[Number]:
    """Return the criteria that have a value and a limit."""
    return [
        of_value(
            one.name,
            one.value.value,
            one.value.unit,
            one.relative_error if one.error_known else None,
            one.source or source,
            verdict(one),
        )
        for one in criteria
        if one.value is not None and one.verdict != "not_checked"
    ]


def verdict(one: Criterion) -> str:
    """Return the verdict on a criterion with its limit; `confirmed` needs a known error and a sure limit."""
    is_sure = one.is_confirmed and one.unverified is None
    notes = {
        "error unknown": one.verdict == "met" and not one.error_known,
        "limit unverified": one.unverified is not None,
        "waived": one.waived is not None,
    }
    word = "confirmed" if is_sure else one.verdict.replace("_", " ")
    return limited(word, one.limit, [note for note, holds in notes.items() if holds])


def limited(word: str, limit: Quantity | None, notes: Sequence[str]) -> str:
    """Return a verdict with its limit and notes in brackets."""
    limits = [f"limit {_rounded(limit.value)}{_unit(limit.unit)}"] if limit else []
    return f"{word} ({', '.join([*limits, *notes])})" if limits or notes else word


def _unit(unit: str | None) -> str:
    return "" if unit in (None, "1") else f" {unit}"


def _verdict_of(output: str, criteria: Iterable[Criterion]) -> str:
    """Return the verdict on an output by the worst criterion that compares it."""
    own = (one for one in criteria if one.require.split()[0] == output and one.verdict != "not_checked")
    return next((verdict(one) for one in own), "no limit")


def of_value(
    name: str, value: object, unit: str | None, error: float | None, source: str, verdict: str
) -> Number:
    """Return a value as every tool shows it."""
    return Number(
        name=name, value=_plain(value), unit=unit, error=error,
        source=shortened(source, LONGEST_SOURCE), verdict=verdict,
    )  # fmt: skip


def _plain(value: object) -> Plain:
    """Return a number with six digits, the span of a list, or a short text."""
    if isinstance(value, (list, tuple)):
        flat = [one for one in _flat(value) if isinstance(one, (int, float))]
        ends = f" from {_rounded(min(flat))} to {_rounded(max(flat))}" if flat else ""
        return f"{len(value)} values{ends}"
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return _rounded(value)
    return None if value is None else plain(str(value), 80)


def _flat(values: Iterable[object]) -> Iterator[object]:
    for one in values:
        if isinstance(one, (list, tuple)):
            yield from _flat(one)
        else:
            yield one


def _largest(error: object) -> float | None:
    """Return the largest error of all points; None if one is unknown."""
    errors = [*_flat(error)] if isinstance(error, list) else [error]
    numbers = [float(one) for one in errors if isinstance(one, (int, float))]
    return max(numbers) if numbers and len(numbers) == len(errors) else None


def _rounded(value: float) -> float:
    return float(f"{value:.{_DIGITS}g}")


def _size(result: mcp.CallToolResult) -> int:
    return len(result.model_dump_json(by_alias=True, exclude_unset=True).encode())
