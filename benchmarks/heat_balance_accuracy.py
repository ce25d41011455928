"""Measure how much a heat balance adds to the errors of `oil_film` 2, on random bearings.

    python -m benchmarks.heat_balance_accuracy     three minutes; prints the values of the accuracy file

`benchmarks.accuracy measure` calls this module and writes the file. The errors in its tables are those of a
film at a given viscosity. With a heat balance, friction and side flow determine the temperature, and the
temperature determines the viscosity. Every level takes friction and side flow from the map, so errors of the
map affect every output.

At each of the 2100 points (eps, B/D) of the film's checks there is a random bearing for each of three oils,
once with cooling by the oil and once with cooling by air. The true temperature is the one at which the power
loss of the *converged* film is removed; the load is the one that this film carries. The added error is the
result of a level at the temperature of its balance minus its result at the true temperature. The table
contains 1.5 times the largest of these.

Level mass_conserving takes 0.2 s per bearing, so it calculates only 64 bearings of each oil and kind of
cooling. If the map adds more to all bearings than that level to these, the value of the map is used. The
friction of that level follows another convention than the balance, so no error of friction and power is
stated there. Finally the script prints the effect of a balance with the other convention. That effect is not
an error, because ISO 7902-1 has shear over the full circle.
"""

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.truths import FILM, FRICTION, converged
from templates.core.arrays import Array
from templates.core.criteria.bands import relative_error
from templates.core.language.spec import Text
from templates.core.units.quantity import TypedQuantity
from templates.oil_film.oil_film_v2 import OilFilm
from templates.physics.journals.heat_balance import HOTTEST, HeatBalance
from templates.physics.journals.static_journal import JournalFilm
from templates.physics.numerics.roots import bracketed_root

SEED = 13
MARGIN = 1.5
GRADES = ("iso_vg_10", "sae_15w_40", "iso_vg_320")
LEVELS = {"short_bearing": "short_bearing", "fit": "fit", "map": "map", "reynolds": "map"}
"""Each level, and the level at which it is measured: level reynolds depends on the viscosity as the map
does."""
SLOW, PICKED = "mass_conserving", 64
"""A level that is measured on fewer bearings, and their number for each oil and kind of cooling."""
HOT = 250.0 + 273.15
"""Bearings hotter than this are left out: their oil would burn [K]."""
HEAT_CAPACITY = 1.8e6
"""The template's default [J/(m³ K)]."""
ZERO = ("couple_across_load", "couple_along_load")
"""Outputs that are zero for these bearings, which are all aligned."""
ANGLES = ("attitude_angle", "maximum_pressure_angle")
INPUTS = ("supply_temperature", "ambient_temperature")


@dataclass(frozen=True)
class Bearings:
    """Random bearings in equilibrium: what a user would type, and the true film temperature [K]."""

    inputs: dict[str, Any]
    T: Array
    T_out: Array
    film: JournalFilm

    def template(self) -> OilFilm:
        """Return the template, with the balance as it calculates it."""
        return OilFilm.from_quantities(self.inputs)

    def in_equilibrium(self, level: str) -> OilFilm:
        """Return the bearings at a level, at the true temperature."""
        template = self.template().at(level)
        vars(template)["balance"] = HeatBalance(self.T, self.T_out, np.zeros(self.T.shape))
        return template

    def some(self, rows: NDArray[np.intp]) -> "Bearings":
        """Return a subset of the bearings."""
        inputs = {
            n: replace(v, si=np.asarray(v.si)[rows]) if isinstance(v, TypedQuantity) else v
            for n, v in self.inputs.items()
        }
        film = replace(self.film, **{f.name: getattr(self.film, f.name)[rows] for f in fields(self.film)})
        return Bearings(inputs, self.T[rows], self.T_out[rows], film)


def drawn(
    rng: np.random.Generator, film: JournalFilm, ratio: Array, grade: str, *, supplied: bool
) -> Bearings:
    """Return a random bearing for each film, cooled by its oil or by air."""
    count = ratio.size
    D, psi, omega = (
        np.exp(rng.uniform(np.log(low), np.log(high), count))
        for low, high in ((0.02, 0.5), (5e-4, 3e-3), (20.0, 1000.0))
    )
    cold = rng.uniform(20, 80, count) + 273.15
    oil = OilFilm.from_quantities({**OilFilm.example, "oil_grade": grade})
    scale = ratio * D**2 * omega / psi**2
    couple = film.eps * film.So * np.sin(film.attitude) / 2

    def viscosity(T: Array) -> Array:
        return _viscosity(oil, T)

    def power(T: Array) -> Array:
        return np.asarray(scale * viscosity(T) * psi * D / 2 * (film.shear + couple) * omega)

    carried = HEAT_CAPACITY * film.side_flow * (D / 2) ** 3 * psi * omega * 2
    rise = np.exp(rng.uniform(np.log(2), np.log(120), count))
    if supplied:
        rise = bracketed_root(
            lambda r: 1 - carried * r / power(cold + r), np.zeros(count), HOTTEST - cold, 1e-13
        )
    T = cold + rise
    cool = {"supply_temperature": (cold, "K")} if supplied else {
        "ambient_temperature": (cold, "K"), "heat_transfer": (power(T) / rise, "W/K")
    }  # fmt: skip
    load = {"radial_load": (film.So * scale * viscosity(T), "N"), "bearing_diameter": (D, "m")}
    size = {
        "bearing_width": (ratio * D, "m"),
        "diametral_clearance": (psi * D, "m"),
        "speed": (omega, "rad/s"),
    }
    keep = np.isfinite(T) & (T < HOT)
    inputs = {n: TypedQuantity(None, unit, v[keep], {}) for n, (v, unit) in {**load, **size, **cool}.items()}
    T_out = 2 * T - cold if supplied else np.full(count, np.nan)
    kept = replace(film, **{f.name: np.asarray(getattr(film, f.name))[keep] for f in fields(film)})
    return Bearings({**inputs, "oil_grade": grade}, T[keep], T_out[keep], kept)


def _viscosity(oil: OilFilm, T: Array) -> Array:
    """Return the dynamic viscosity of an oil at T [K], by the template's own formulas [Pa s]."""
    warm = oil.at("map")
    vars(warm)["T_film"] = T
    return np.asarray(warm.eta)


def change(output: str, value: Array, true: Array, largest: Array) -> Array:
    """Return the difference of two results, in the error measure of the tables."""
    return np.asarray(relative_error(value, true, np.pi / 2 if output in ANGLES else largest))


def sizes(template: OilFilm, output: str) -> Array:
    """Return the reference value of an error: the largest of four coefficients, or the value itself."""
    kind = output.partition("_")[0]
    if kind in ("stiffness", "damping") and not output.endswith("scale"):
        names = [f"{kind}_{xy}" for xy in ("xx", "xy", "yx", "yy")]
        return np.asarray(np.max([np.abs(value_of(template, name)) for name in names], axis=0))
    return np.abs(value_of(template, output))


def value_of(template: OilFilm, output: str) -> Array:
    """Return an output in SI."""
    return np.asarray(getattr(template, OilFilm.formulas[output].attribute))


def dependent() -> list[str]:
    """Return the outputs that depend on a heat balance."""
    return [
        name
        for name, formula in OilFilm.formulas.items()
        if name not in ZERO
        and not isinstance(formula, Text)
        and "balance" in OilFilm.ancestors(formula.attribute)
    ]


def ensemble(seed: int, *, streamers: bool = False) -> Iterator[Bearings]:
    """Yield all bearings by oil and kind of cooling; with `streamers`, shear acts only where there is oil."""
    rng = np.random.default_rng(seed)
    _, y, film, _ = converged(streamers=streamers)
    for grade in GRADES:
        for supplied in (True, False):
            yield drawn(rng, film, np.exp(y), grade, supplied=supplied)


def added(bearings: Bearings, level: str) -> dict[str, float]:
    """Return the largest change of each output at a level; None if the level does not have the output."""
    own, true = bearings.template().at(level), bearings.in_equilibrium(level)
    with np.errstate(all="ignore"):
        shares = {
            name: change(name, value_of(own, name), value_of(true, name), sizes(true, name))
            for name in dependent()
            if name != "heat_balance_residual"
        }
    return {name: float(np.nanmax(e)) for name, e in shares.items() if np.isfinite(e).any()}


def upwards(value: float) -> float:
    """Return a number rounded up to two digits."""
    unit = 10.0 ** (np.floor(np.log10(max(value, 1e-12))) - 1)
    return float(f"{np.ceil(value / unit) * unit:.2g}")


def largest(each: Iterator[dict[str, float]]) -> dict[str, float]:
    """Return the largest change of each output."""
    most: dict[str, float] = {}
    for changes in each:
        for name, change in changes.items():
            most[name] = max(most.get(name, 0.0), change)
    return most


def slowly(every: list[Bearings], of_map: dict[str, float]) -> dict[str, float]:
    """Return the added error at the slow level.

    It is measured on some bearings, and is at least the error that the map adds to all.
    """
    rng = np.random.default_rng(SEED)
    some = [one.some(rng.choice(one.T.size, PICKED, replace=False)) for one in every]
    measured = largest(added(one, SLOW) for one in some)
    fast = largest(added(one, "map") for one in some)
    kept = {name: value for name, value in measured.items() if name not in FRICTION}
    for name, value in kept.items():
        print(f"{SLOW}, {name}: {value:.3g}, where the map adds {fast.get(name, np.nan):.3g}", flush=True)
    return {name: max(value, of_map.get(name, 0.0)) for name, value in kept.items()}


def other_convention() -> None:
    """Print the change of the film if the balance used shear only where there is oil."""
    film = "minimum_film_thickness"
    shares = []
    for one in ensemble(SEED, streamers=True):
        own, other = (value_of(each, film) for each in (one.template().at("map"), one.in_equilibrium("map")))
        shares.append(other / own - 1)
    every = np.concatenate(shares)
    low, middle, high = np.nanquantile(every[np.isfinite(every)], [0, 0.5, 1])
    print(f"shear where oil is would make the film thicker by {low:.1%} to {high:.1%}, median {middle:.1%}")


def heat_balance() -> dict[str, Any]:
    """Return the error that a heat balance adds at each level, for the accuracy file."""
    every = list(ensemble(SEED))
    count = sum(one.T.size for one in every)
    fast = {level: largest(added(one, level) for one in every) for level in set(LEVELS.values())}
    measured = {level: fast[source] for level, source in LEVELS.items()}
    measured[SLOW] = slowly(every, fast["map"])
    return {
        "name": "heat balance",
        "inputs": list(INPUTS),
        "made_by": "python -m benchmarks.accuracy measure",
        "truth": f"{FILM}, at the temperature at which its shear all around heats what carries heat off",
        "error": f"comes on top; the largest of {count} random bearings, half of it added; of a "
        f"temperature relative to the absolute one; at level {SLOW} checked on {PICKED * len(every)} of "
        "them, and null for friction and power, whose convention is not the balance's",
        "added": {
            level: {name: upwards(MARGIN * error) for name, error in errors.items()}
            for level, errors in measured.items()
        },
    }


def main() -> None:
    """Print the additions, and what a balance of the other convention would change."""
    for level, table in heat_balance()["added"].items():
        print(level, table)
    other_convention()


if __name__ == "__main__":
    main()
