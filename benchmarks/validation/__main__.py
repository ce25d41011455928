"""Calculate the published cases and write docs/validation.md: `python -m benchmarks.validation [CASE …]`.

Without arguments all cases are calculated. With the keys of some, only these are, and the page shows the kept
results of the others. `python -m benchmarks.validation new` calculates the cases without a kept result, and
`python -m benchmarks.validation kept` only writes the page.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping, Sequence

from benchmarks.validation.page import write
from benchmarks.validation.results import RESULTS
from templates.validate.case import Case, Numbers
from templates.validate.cases import CASES, calculated, named
from templates.validate.comparison import row


def main(names: list[str]) -> None:
    """Calculate the named cases, keep their results and write the page."""
    results: dict[str, Numbers] = json.loads(RESULTS.read_text()) if RESULTS.exists() else {}
    for case, found, seconds in calculated(chosen(names, results)):
        results[case.key] = found
        print(row(case, found), f"{seconds:.1f} s", flush=True)
    results = {case.key: results[case.key] for case in CASES}
    RESULTS.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    write(results)


def chosen(names: list[str], results: Mapping[str, Numbers]) -> Sequence[Case]:
    """Return the cases to calculate."""
    if names == ["new"]:
        return [case for case in CASES if case.key not in results]
    if names == ["kept"]:
        return []
    return named(names) if names else CASES


if __name__ == "__main__":
    main(sys.argv[1:])
