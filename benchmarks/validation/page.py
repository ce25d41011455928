"""Write docs/validation.md from the published numbers and our kept results."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path

from benchmarks.validation.gaps import NO_MODEL, NOT_FOUND, NOT_OBTAINED
from benchmarks.validation.plot import svg
from templates.validate.case import Case, Numbers
from templates.validate.cases import CASES
from templates.validate.comparison import Comparison, agrees, comparisons, farthest

DOCS = Path(__file__).parents[2] / "docs"
PAGE = DOCS / "validation.md"
PICTURES = DOCS / "pictures" / "validation"

HEAD = """\
# Published bearings, cranks and engines beside our results

`python -m benchmarks.validation` calculates each published case, and writes this page. The numbers and their
sources are in `tests/references`; each number was read in the source that its file names as *opened*.

- **Case**: one published bearing, crank, engine or machine, at one condition or at the conditions of one
  table. Rows of a table are one case, unless they are different bearings. A case that two templates calculate
  counts once.
- **Theirs ± uncertainty**: the published number, and what its print, its reading and its method leave open;
  the section of the case states the basis. For a measurement it is the reading, not the scatter of the
  test, unless the source states that scatter.
- **Agrees**: *every* compared number lies within the uncertainty of the published one. **Differs** is in red;
  the section of the case gives the reason, or says that it is unknown. No input was adjusted to a result.
- The tables show the number that is farthest from the published one, as a multiple of the uncertainty.
"""

TABLE = "| quantity | values | ours over theirs, median | farthest: ours | theirs ± uncertainty | verdict |"


def page(results: Mapping[str, Numbers]) -> str:
    """Return the whole page."""
    done = [(case, comparisons(case, results[case.key])) for case in CASES]
    parts = [HEAD, _counts(done), "## All cases\n", *_summary(done), "", *_gaps()]
    return "\n".join([*parts, *(_section(case, compared) for case, compared in done)])


def pictures(results: Mapping[str, Numbers]) -> dict[str, str]:
    """Return the picture of each case by file name."""
    return {f"{case.key}.svg": svg(case, comparisons(case, results[case.key])) for case in CASES}


def write(results: Mapping[str, Numbers]) -> None:
    """Write the page and its pictures, and delete the picture of a case that no longer exists."""
    PAGE.write_text(page(results), encoding="utf-8")
    PICTURES.mkdir(parents=True, exist_ok=True)
    drawn = pictures(results)
    for old in PICTURES.glob("*.svg"):
        if old.name not in drawn:
            old.unlink()
    for name, picture in drawn.items():
        (PICTURES / name).write_text(picture, encoding="utf-8")


def _counts(done: list[tuple[Case, list[Comparison]]]) -> str:
    published = {(case.file, *case.rows.values()) for case, _ in done}
    sources = {case.reference.head["source"] for case, _ in done}
    kinds = Counter(case.kind for case, _ in done)
    agreed = sum(agrees(compared) for _, compared in done)
    number = f"{len(published)} published cases from {len(sources)} sources, in {len(done)} comparisons"
    each = ", ".join(f"{count} × {kind}" for kind, count in sorted(kinds.items()))
    return f"**{number}: {agreed} agree, {len(done) - agreed} differ.** By kind: {each}.\n"


def _summary(done: list[tuple[Case, list[Comparison]]]) -> Iterator[str]:
    yield "| case | kind | calculated by | compared | ours | theirs ± uncertainty | verdict |"
    yield "|---|---|---|---|---|---|---|"
    for case, compared in done:
        shown = farthest(compared)
        n = shown.worst
        theirs = f"{_number(shown.theirs[n])} ± {_number(shown.uncertainties[n], 2)}"
        cells = [f"[{case.title}](#{case.key})", case.kind, f"`{case.subject}`", _words(shown)]
        cells += [_number(shown.ours[n]), theirs, _verdict(agrees(compared))]
        yield f"| {' | '.join(cells)} |"


def _section(case: Case, compared: list[Comparison]) -> str:
    head = case.reference.head
    lines = [f"## {case.title} {{ #{case.key} }}", ""]
    lines += [f"![{_alternative(case)}](pictures/validation/{case.key}.svg){{ width=360 }}", ""]
    lines += [TABLE, "|---|---|---|---|---|---|", *map(_line, compared), ""]
    lines += [f"{'Reason' if not agrees(compared) else 'Remark'}: {case.because}", ""] if case.because else []
    lines += [f"- Source: {head['source']}", f"- Opened: {head['opened']}", f"- Read: {head['read']}"]
    lines += [f"- Uncertainty: {head['uncertainty']}", f"- Numbers: `tests/references/{case.file}`", ""]
    return "\n".join(lines)


def _line(comparison: Comparison) -> str:
    n, ratio = comparison.worst, comparison.median_ratio
    theirs = f"{_number(comparison.theirs[n])} ± {_number(comparison.uncertainties[n], 2)}"
    middle = "–" if ratio is None else f"{ratio:.3f}"
    count = len(comparison.theirs)
    verdict = "agrees" if not comparison.missed else _red(f"differs in {comparison.missed} of {count}")
    cells = [_words(comparison), str(count), middle, _number(comparison.ours[n]), theirs, verdict]
    return f"| {' | '.join(cells)} |"


def _alternative(case: Case) -> str:
    return f"{case.title}: published numbers and ours"


def _words(comparison: Comparison) -> str:
    column = comparison.column
    return column.words if column.unit in ("1", "") else f"{column.words} [{column.unit}]"


def _verdict(is_met: bool) -> str:
    return "agrees" if is_met else _red("differs")


def _red(text: str) -> str:
    return f'<span class="differs">{text}</span>'


def _number(value: float, digits: int = 4) -> str:
    return f"{value:.{digits}g}"


def _gaps() -> Iterator[str]:
    """Yield what was looked for without success."""
    yield "## Sources that were not obtained\n"
    yield "These do not count; numbers could not be read in any copy that was at hand.\n"
    yield from (f"- {line}" for line in NOT_OBTAINED)
    yield ""
    yield "## Templates and models without a published case\n"
    yield from (f"- `{name}`: {reason}" for name, reason in NOT_FOUND.items())
    yield f"- {NO_MODEL}"
    yield ""
