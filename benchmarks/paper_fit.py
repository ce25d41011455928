"""Measure the error of the film thickness of `oil_film` 1: the paper's fit against the Reynolds film.

    python -m benchmarks.paper_fit

The bearing has the width of the paper's, W/D = 32/85, and an isothermal Swift–Stieber film. Both films have
the same Sommerfeld number, so that viscosity and load cancel. The converged film is that of the map, whose
own error is printed too.
"""

import numpy as np

from templates.physics.films.film_map import map_error
from templates.physics.films.film_map_inverse import mapped_eccentricity
from templates.physics.numerics.power_fit import exponent_k2, factor_k1

RATIO = np.array(32 / 85)
NUMBERS = (1, 1.9, 3.948, 5, 10, 40, 100, 200)


def main() -> None:
    """Print the table."""
    print(f"{'So':>7} {'eps, fit':>9} {'eps, film':>10} {'h0 is off by':>13}  (error of the film's load)")
    for number in map(np.array, NUMBERS):
        fit = factor_k1(number) * number ** exponent_k2(number)
        film = mapped_eccentricity(number, RATIO)
        off, error = (1 - fit) / (1 - film) - 1, map_error(film, RATIO)[0]
        print(f"{number:7g} {fit:9.4f} {film:10.4f} {off:+13.1%}  ({error:.0e})")


if __name__ == "__main__":
    main()
