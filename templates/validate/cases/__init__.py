"""All published cases, in the order of the page: a file of tests/references and an entry here for each."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterable, Iterator, Sequence

from templates.validate.case import Case, Numbers
from templates.validate.cases.engines import ENGINES
from templates.validate.cases.fatigue import FATIGUE
from templates.validate.cases.loaded_films import LOADED_FILMS
from templates.validate.cases.pads import PADS
from templates.validate.cases.shafts import SHAFTS
from templates.validate.cases.static_films import STATIC_FILMS

CASES: tuple[Case, ...] = (*STATIC_FILMS, *LOADED_FILMS, *PADS, *ENGINES, *SHAFTS, *FATIGUE)


def named(names: Sequence[str]) -> list[Case]:
    """Return the cases of these keys; a key that does not exist ends the program with a message."""
    unknown = set(names) - {case.key for case in CASES}
    if unknown:
        sys.exit(f"no case {', '.join(sorted(unknown))}; the cases are {', '.join(c.key for c in CASES)}")
    return [case for case in CASES if case.key in names]


def calculated(cases: Iterable[Case]) -> Iterator[tuple[Case, Numbers, float]]:
    """Yield each case with our values and the processor time of its calculation [s]."""
    for case in cases:
        begin = time.process_time()
        found = case.calculate()
        yield case, found, time.process_time() - begin
