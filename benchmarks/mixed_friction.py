"""Error of `mixed_friction` 1 at level map and of its interpolation, and random inputs.

python -m benchmarks.mixed_friction            about a minute
python -m benchmarks.mixed_friction random     10 000 random bearings at level map, 100 at level averaged

Flow factors: load by the average Reynolds equation over that of smooth faces at one eccentricity, less 1.
Interpolation: level averaged between its nodes, 64 × 8 intervals, against the equation on 128 × 16.
"""

import sys
from time import process_time

import numpy as np

from templates.core.language.evaluate import evaluate
from templates.oil_film.mixed_friction_v1 import MixedFriction
from templates.physics.films.film_map import mapped_film
from templates.physics.journals.mixed_journal import AveragedFilms
from templates.physics.roughness.flow_factors import rough_journal


def flow_factors() -> None:
    """Print what flow factors make of the load, by gap over roughness."""
    print(
        "gap/sigma: load over smooth, less 1, in per cent, for asymmetry -1, 0, 1 (B/D 0.5, sigma/c_r 0.02)"
    )
    for gap in (10, 5, 3, 2.5, 2, 1, 0.5):
        eps = 1 - gap * 0.02
        smooth = float(mapped_film(np.asarray(eps), np.asarray(0.5))["So"])
        loads = [rough_journal(eps, 0.5, 0.02, one, 128, 16)[0] / smooth - 1 for one in (-1, 0, 1)]
        print(f"{gap:5}", *(f"{100 * load:7.1f}" for load in loads))


def interpolation() -> None:
    """Print the largest errors of load and attitude between the nodes."""
    rng, worst = np.random.default_rng(5), np.zeros(2)
    for _ in range(40):
        ratio, roughness, one = 10 ** rng.uniform(-1, 0.5), 10 ** rng.uniform(-3.5, -1.3), rng.uniform(-1, 1)
        films = AveragedFilms(np.array([ratio]), np.array([roughness]), np.array([one]))
        for deep in rng.uniform(films.low[0], films.high[0], 4):
            eps = float(-np.expm1(-deep))
            load, attitude = films.at(np.array([eps]), np.array([0]))
            exact = rough_journal(eps, ratio, roughness, one, 128, 16)
            worst = np.maximum(worst, [abs(load[0] / exact[0] - 1), abs(attitude[0] - exact[1])])
    print(f"interpolation: load errs by {worst[0]:.1e} at most, the attitude by {worst[1]:.1e} rad")


def random_bearings(level: str, count: int, at_once: int) -> None:
    """Evaluate random bearings; print how many have an answer, and the cost."""
    rng, answered, begin = np.random.default_rng(23), 0, process_time()
    for _ in range(count // at_once):
        spans = {"radial_load": (-3, 6, "N"), "speed": (-4, 5, "rpm"), "dynamic_viscosity": (-1, 4, "mPa*s"),
                 "journal_roughness": (-4, 2, "um"), "bearing_roughness": (-4, 2, "um"),
                 "roughness_product": (-3, 0, "1"), "summit_slenderness": (-4, 0, "1"),
                 "composite_modulus": (-1, 3, "GPa"), "contact_friction": (-3, 0, "1")}  # fmt: skip
        drawn = {n: (10 ** rng.uniform(low, high, at_once), u) for n, (low, high, u) in spans.items()}
        D = 10 ** rng.uniform(0, 3, at_once)
        drawn["bearing_diameter"] = D, "mm"
        drawn["bearing_width"] = D * 10 ** rng.uniform(-2, 2, at_once), "mm"
        drawn["diametral_clearance"] = D * 10 ** rng.uniform(-5, -1, at_once), "mm"
        raw = {name: {"value": value.tolist(), "unit": unit} for name, (value, unit) in drawn.items()}
        outputs = evaluate(MixedFriction, raw, level=level).outputs
        for name, one in outputs.items():
            values = np.asarray(one.value) if name != "lubrication_regime" else np.zeros(at_once)
            missing = np.isnan(values.reshape(at_once, -1)).any(axis=1) if values.ndim else np.zeros(at_once)
            reasons = np.full(at_once, one.reason) if one.reasons is None else one.reasons
            assert all(reasons[i] for i in np.flatnonzero(missing)), name
        answered += int(np.isfinite(outputs["friction_coefficient"].value).sum())
    seconds = process_time() - begin
    print(
        f"{level}: {answered} of {count} answered, none without a reason, {1e3 * seconds / count:.1f} ms each"
    )


def main() -> None:
    """All, or the random bearings."""
    if sys.argv[1:] == ["random"]:
        random_bearings("map", 10_000, 1_000)
        random_bearings("averaged", 100, 50)
        return
    flow_factors()
    interpolation()


if __name__ == "__main__":
    main()
