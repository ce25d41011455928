"""The film around a whole bearing: balances at every node, and periodic ends."""

import numpy as np
import pytest

from templates.physics.films.complementarity import rupture
from templates.physics.films.film_equations import Equations

N, M = 24, 6


def ring(phase):
    """A film that narrows and widens once around, with its thinnest place anywhere."""
    nodes = np.linspace(0, 2 * np.pi, N + 1) + phase
    middles = (nodes[1:] + nodes[:-1]) / 2
    step = 2 * np.pi / N
    gap = 1 + 0.6 * np.cos(nodes)
    gains = 6 * 0.6 * np.sin(nodes) * step  # −6 dH/dphi, of a whole cell
    across = gap**3 * step
    for ends in (gains, across):
        ends[[0, -1]] /= 2
    return Equations(
        (1 + 0.6 * np.cos(middles)) ** 3 / step, across, gains, np.linspace(0, 1, M + 1), ring=True
    )


@pytest.mark.parametrize("phase", [0.0, 1.0, 2.5, 4.0])
def test_property_ends_meet_and_every_node_balances(phase):
    equations = ring(phase)
    solved = rupture(equations)
    P, film = solved.P, solved.film
    assert np.array_equal(P[0], P[-1])
    assert 0 < film.sum() < film.size
    excess = equations.residual(P)
    inside = film[:-1, 1:-1]
    scale = np.abs(equations.source).max()
    assert np.abs(excess[:-1, 1:-1][inside]).max() < 1e-9 * scale
    assert excess[:-1, 1:-1][~inside].min() > -1e-9 * scale
    assert P[:-1][~film[:-1]].max() == 0 < P.max()


def test_property_the_film_turns_with_the_bearing():
    """A turn by whole intervals gives the same pressures at other nodes, also across the ends."""
    turned = rupture(ring(2 * np.pi * 7 / N)).P[:-1]
    assert turned == pytest.approx(np.roll(rupture(ring(0.0)).P[:-1], -7, axis=0), abs=1e-12)
