"""Calculate published cases and print them beside our results: `python -m templates.validate [CASE …]`.

Without arguments all cases are calculated. The published numbers are in `tests/references` of the repository,
so this needs a clone; it needs neither CadQuery nor a service. docs/validation.md shows plots and reasons.
"""

from __future__ import annotations

import sys

from templates.validate.cases import CASES, calculated, named
from templates.validate.comparison import agrees, comparisons, row
from templates.validate.reference import FOLDER


def main(names: list[str]) -> None:
    """Print a line for each case, and how many agree."""
    if not FOLDER.is_dir():
        sys.exit(f"{FOLDER} is absent: run this in a clone of the repository")
    agreed = []
    for case, found, seconds in calculated(named(names) if names else CASES):
        agreed.append(agrees(comparisons(case, found)))
        print(row(case, found), f"{seconds:.1f} s", flush=True)
    print(f"{sum(agreed)} of {len(agreed)} agree; docs/validation.md gives the reason of each difference")


if __name__ == "__main__":
    main(sys.argv[1:])
