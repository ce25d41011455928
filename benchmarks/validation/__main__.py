"""Calculate the published cases and write docs/validation.md: `python -m benchmarks.validation [CASE …]`.

Without arguments all cases are calculated. With the keys of some, only these are, and the page shows the kept
results of the others. `python -m benchmarks.validation new` calculates the cases without a kept result, and
`python -m benchmarks.validation kept` only writes the page.
"""

from __future__ import annotations

import json
import sys
import time

from benchmarks.validation.case import Case, Numbers
from benchmarks.validation.cases import CASES
from benchmarks.validation.comparison import RESULTS, agrees, comparisons, farthest
from benchmarks.validation.page import write


def main(names: list[str]) -> None:
    """Calculate the named cases, keep their results and write the page."""
    results: dict[str, Numbers] = json.loads(RESULTS.read_text()) if RESULTS.exists() else {}
    for case in chosen(names, results):
        begin = time.process_time()
        results[case.key] = case.calculate()
        print(line(case, results[case.key]), f"{time.process_time() - begin:.1f} s", flush=True)
    results = {case.key: results[case.key] for case in CASES}
    RESULTS.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    write(results)


def chosen(names: list[str], results: dict[str, Numbers]) -> list[Case]:
    """Return the cases to calculate."""
    if names == ["new"]:
        return [case for case in CASES if case.key not in results]
    unknown = set(names) - {case.key for case in CASES} - {"kept"}
    if unknown:
        sys.exit(f"no case {', '.join(sorted(unknown))}")
    return [case for case in CASES if not names or case.key in names]


def line(case: Case, found: Numbers) -> str:
    """Return the result of a case: the number that is farthest from the published one."""
    compared = comparisons(case, found)
    shown = farthest(compared)
    n = shown.worst
    verdict = "agrees " if agrees(compared) else "DIFFERS"
    allowed = f"{shown.theirs[n]:.5g} ± {shown.uncertainties[n]:.2g}"
    return f"{case.key:32} {verdict} {shown.column.name:12} ours {shown.ours[n]:.5g}, theirs {allowed}"


if __name__ == "__main__":
    main(sys.argv[1:])
