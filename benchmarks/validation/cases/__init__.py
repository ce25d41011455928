"""All published cases, in the order of the page: a file of tests/references and an entry here for each."""

from benchmarks.validation.case import Case
from benchmarks.validation.cases.engines import ENGINES
from benchmarks.validation.cases.fatigue import FATIGUE
from benchmarks.validation.cases.loaded_films import LOADED_FILMS
from benchmarks.validation.cases.pads import PADS
from benchmarks.validation.cases.shafts import SHAFTS
from benchmarks.validation.cases.static_films import STATIC_FILMS

CASES: tuple[Case, ...] = (*STATIC_FILMS, *LOADED_FILMS, *PADS, *ENGINES, *SHAFTS, *FATIGUE)

NOT_OBTAINED: tuple[str, ...] = ()
"""Sources that could not be opened."""

NOT_FOUND: dict[str, str] = {
    "combustion_cycle 1": "not looked for yet",
    "crank_stiffness 1": "not looked for yet",
    "crankshaft_strength 1": "not looked for yet",
    "cycle_heat_balance 1": "not looked for yet",
    "measured_curves 1": "not looked for yet",
    "oil_film 1": "not looked for yet",
    "oil_film_cycle 1": "not looked for yet",
    "thermal_clearance 1": "not looked for yet",
    "thermal_film 1": "not looked for yet",
    "thrust_bearing 1": "not looked for yet",
}
"""Templates without a published case, and what was looked for."""
