"""Light loads on grooves all around that do not repeat: two meshes, and a film that never ruptures.

    python -m benchmarks.half_speed_load

Two of the grooves all around in benchmarks/results/film_cycle_ensemble.jsonl do not repeat: number 146 of
seed 1 wanders, number 51 of seed 3 is called starved. Each is marched on two meshes from the same start,
without the verdict that would end it. Beside it moves the same journal in a film that never ruptures, between
two short lands, in closed form:

    S = 4 pi (1 - g) b**2 ( e_r' (1 + 2 e**2)/(1 - e**2)**(5/2),  e phi' /(1 - e**2)**(3/2) )

in axes that turn with the mean speed of journal and sleeve; b is the width ratio of a land and g the groove's
share of the width. Such a film resists velocities alone. A load with a part that stands still in these axes
therefore moves the journal further in every cycle.

The script prints that part of the load, a mean over 720 degrees, and the smallest gap of cycles on the way.
Both take some 20 s of processor time.
"""

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.film_cycle_duties import drawn
from benchmarks.supplied_duties import RandomDuty
from templates.core.arrays import Array
from templates.physics.supplied.supplied_march import Duty, gap_at, marched, start
from templates.physics.supplied.supplied_mesh import Mesh, supplied_mesh
from templates.physics.supplied.supplied_orbit import COARSE, FINE, MASS, Meshing
from templates.physics.supplied.supplied_run import in_frame

CASES = ((1, 146), (3, 51))
"""Seed and number."""
CYCLES, SHOWN = 48, (1, 6, 12, 24, 36, 48)


def never_ruptures(duty: Duty, drawn_duty: RandomDuty) -> list[float]:
    """Smallest gap of each cycle in a film that is always full, between two short lands [-]."""
    share = drawn_duty.supply.pockets[0].half_length
    size = 4 * np.pi * (1 - share) * (drawn_duty.ratio * (1 - share) / 2) ** 2
    period, gaps = duty.load.period, []

    def velocity(theta: float, e: Array) -> Array:
        S = duty.seen(np.array([theta]))[0][0]
        eps = float(np.hypot(*e))
        along = e / eps if eps > 0 else np.array([1.0, 0.0])
        radial, left = float(S @ along), 1 - eps**2
        return np.asarray(
            (radial * along * left**2.5 / (1 + 2 * eps**2) + (S - radial * along) * left**1.5) / size
        )

    e = start(meshed(drawn_duty, COARSE), duty).e
    for cycle in range(CYCLES):
        begin = duty.begin + cycle * period
        solved = solve_ivp(velocity, (begin, begin + period), e, rtol=1e-7, atol=1e-9, max_step=period / 90)
        e = solved.y[:, -1]
        gaps.append(1 - float(np.hypot(*solved.y).max()))
    return gaps


def meshed(drawn_duty: RandomDuty, meshing: Meshing) -> Mesh:
    """A mesh of the duty, of a gap that is not thin."""
    edges = drawn_duty.supply.edges
    return supplied_mesh(drawn_duty.ratio, meshing.around, meshing.across, edges, True, 1.0, 1.0)


def on_mesh(duty: Duty, drawn_duty: RandomDuty, meshing: Meshing) -> tuple[list[float], float]:
    """Smallest gap of each cycle on a mesh, and the largest share of void in the last [-]."""
    mesh = meshed(drawn_duty, meshing)
    states, gaps = [start(mesh, duty)], []
    for _ in range(CYCLES):
        states, _, ended = marched(mesh, duty, states[-1], meshing.step, lambda part: None)
        if not ended:
            break
        gaps.append(1 - float(np.abs(in_frame(duty, states)[1]).max()))
    gap = [gap_at(mesh, state.e)[:, None] * mesh.width for state in states]
    void = max(float((state.void * H).sum() / H.sum()) for state, H in zip(states, gap, strict=True))
    return gaps, void


def described(own: RandomDuty, duty: Duty) -> str:
    """The duty of the bearing."""
    x, y = duty.seen(duty.begin + 4 * np.pi * np.arange(720) / 720)[0].T
    size, still = np.hypot(x, y), np.hypot(x.mean(), y.mean())
    return (
        f"{own.kind}, cycle {np.degrees(own.load.period):.0f}°, B/D {own.ratio:.2f}, "
        f"P {own.supply.pressure:.2f}, load number {size.max():.3f}, mean {size.mean():.3f}, "
        f"of it turning at the mean speed {still:.4f}"
    )


def main() -> None:
    """Print a table of each."""
    for seed, number in CASES:
        _, own = next(drawn(seed, "full_groove", number))
        duty = Duty(own.load, np.asarray(own.sliding, float), own.supply, MASS)
        print(f"seed {seed}, number {number}: {described(own, duty)}")
        rows = {"never ruptures": (never_ruptures(duty, own), 0.0)}
        for meshing in (COARSE, FINE):
            name = f"{meshing.around} x {meshing.across}, {np.degrees(meshing.step):.0f}°"
            rows[name] = on_mesh(duty, own, meshing)
        for name, (gaps, void) in rows.items():
            shown = ", ".join(f"{gaps[n - 1]:.4f}" for n in SHOWN if n <= len(gaps))
            print(f"  {name}: smallest gap in cycles {SHOWN}: {shown}; void at most {100 * void:.1f} %")


if __name__ == "__main__":
    main()
