"""All published cases, in the order of the page: a file of tests/references and an entry here for each."""

from benchmarks.validation.case import Case
from benchmarks.validation.cases.engines import ENGINES
from benchmarks.validation.cases.fatigue import FATIGUE
from benchmarks.validation.cases.loaded_films import LOADED_FILMS
from benchmarks.validation.cases.pads import PADS
from benchmarks.validation.cases.shafts import SHAFTS
from benchmarks.validation.cases.static_films import STATIC_FILMS

CASES: tuple[Case, ...] = (*STATIC_FILMS, *LOADED_FILMS, *PADS, *ENGINES, *SHAFTS, *FATIGUE)
