"""One step and one cycle of a supplied film: conservation, a closed form, and the parts they are made of."""

from dataclasses import replace

import numpy as np
import pytest

from templates.physics.orbits.journal_orbit import CyclicLoad
from templates.physics.supplied import supplied_kernel as kernel
from templates.physics.supplied.supplied_march import Duty, State, TurnedAngle, marched, start, stepped
from templates.physics.supplied.supplied_mesh import supplied_mesh
from templates.physics.supplied.supplied_run import EARLIEST, least_gap, thins
from templates.physics.supplied.supply import Pocket, Supply

HOLE = Supply((Pocket(2.0, np.radians(15), 0.3, on_journal=True),), 0.2)


def silent(_: float) -> None:
    """Nobody listens."""


def constant(S: complex, w: float, sliding: float, supply: Supply = HOLE, mass: float = 0.0) -> Duty:
    """A load at rest, seen from a frame."""
    angle = np.arange(24) * np.pi / 12
    load = np.array([S.real, S.imag])[:, None, None] * np.ones(24)
    cyclic = CyclicLoad(angle, 2 * np.pi, load, np.full((1, 24), w))
    return Duty(cyclic, np.full(24, sliding), supply, mass)


def squeezed(time: float, steps: int) -> float:
    """Eccentricity of a short bearing, ratio 0.02, that a load of 1 presses for a time from its centre."""
    duty = constant(1.0, 0.0, 0.0, Supply((Pocket(np.pi, 0.01, 0.1),), 1e-9))
    load = CyclicLoad(duty.load.angle * time / (2 * np.pi), time, duty.load.S, duty.load.w)
    mesh = supplied_mesh(0.02, 96, 4, (0.1,))
    none = np.zeros((96, mesh.width.size))
    begin = State(0.0, np.zeros(2), none, none, none + 1, np.zeros(2), 0.0)
    return float(
        marched(mesh, Duty(load, duty.sliding, duty.supply, 0.0), begin, time / steps, silent)[0][-1].e[0]
    )


def test_analytic_squeeze_of_a_short_bearing() -> None:
    """The time to eccentricity 0.7 by quadrature of the closed form dP/dzeta² = 12 b² de/dt cos(phi)/H³."""
    b, e, phi = 0.02, 0.7, (np.arange(400) + 0.5) * np.pi / 400 - np.pi / 2
    x, weight = np.polynomial.legendre.leggauss(40)
    rows = 1 - np.outer((x + 1) * e / 2, np.cos(phi))
    force = np.sum(np.cos(phi) ** 2 / rows**3, axis=1) * np.pi / 400
    time = float((weight * e / 2) @ (2 * b**2 * force))
    assert squeezed(time, 400) == pytest.approx(0.7, abs=2e-4)


@pytest.mark.parametrize(
    "rows", [[[1.0, 2.0], [2.0, 4.0]], [[1.0, -3.0], [-2.0, 6.0]], [[5.0, 1.0], [2.0, 3.0]]]
)
def test_a_displacement_is_a_solution_and_of_several_the_shortest(rows: list[list[float]]) -> None:
    """Against the pseudo-inverse, also where the determinant vanishes."""
    (a, b), (c, d) = rows
    wanted = np.linalg.pinv(np.array(rows)) @ [1.0, 2.0]
    assert kernel.displacement(a, b, c, d, 1.0, 2.0) == pytest.approx(wanted, abs=1e-12)


@pytest.mark.parametrize("edges", [(), (0.1,), (0.25,), (0.7,), (0.95,)])
@pytest.mark.parametrize("across", [4, 6, 12])
def test_rows_across_integrate_an_even_parabola(edges: tuple[float, ...], across: int) -> None:
    for grooved in (False, True):
        mesh = supplied_mesh(0.8, 24, across, edges, grooved, gap=0.01)
        z = mesh.zeta[:-1]
        assert mesh.quadrature @ (1 - z**2) == pytest.approx(2 / 3, rel=1e-12)
        assert (np.diff(mesh.zeta) > 0).all()
        assert mesh.width.size == across
        assert set(edges) <= set(mesh.zeta)


def test_nodes_around_are_at_most_two_apart_in_their_order() -> None:
    for around in (24, 25):
        order = supplied_mesh(0.5, around, 4).order
        assert sorted(order) == list(range(around))
        assert np.abs(np.roll(order, -1) - order).max() <= 2


def test_elimination_solves_the_matrix_of_the_flows() -> None:
    rng = np.random.default_rng(3)
    mesh = supplied_mesh(0.6, 20, 4)
    around, across, _ = kernel.coefficients(mesh, np.array([0.5, -0.3]))
    A = kernel.diagonal(mesh, around[0], across[0]) + rng.random((20, 4))
    right = rng.normal(size=(80, 3))
    alpha = np.where(rng.random((20, 4)) < 0.5, 1 / A, 0.0)
    own = np.where(alpha > 0, 1.0, -1.0)
    k, solution = np.empty((20, 4)), right.copy()
    kernel.eliminate(kernel.matrix(mesh, around[0], across[0], alpha, own), solution)
    for i in range(20):
        k[i] = solution[mesh.order[i] * 4 : mesh.order[i] * 4 + 4, 0]
    back = np.empty((20, 4))
    kernel.lost(mesh, around[0], across[0], alpha * k, back)
    back += (own - kernel.diagonal(mesh, around[0], across[0]) * alpha) * k
    for i in range(20):
        assert back[i] == pytest.approx(right[mesh.order[i] * 4 : mesh.order[i] * 4 + 4, 0], abs=1e-10)


def test_slopes_of_conductances_by_differences() -> None:
    mesh, e, nudge = supplied_mesh(0.6, 20, 4), np.array([0.5, -0.3]), 1e-6
    for axis in (0, 1):
        shift = nudge * np.eye(2)[axis]
        above, below = (kernel.coefficients(mesh, e + sign * shift) for sign in (1, -1))
        for high, low, here in zip(above, below, kernel.coefficients(mesh, e), strict=True):
            assert here[1 + axis] == pytest.approx((high[0] - low[0]) / (2 * nudge), rel=1e-6)


def test_every_step_bears_its_load_keeps_its_oil_and_is_complementary() -> None:
    """First order, so that the balance of a step is exact: stored = fed − lost."""
    duty = constant(2.0 + 1.0j, 0.5, 1.0)
    mesh = supplied_mesh(0.5, 48, 4, duty.supply.edges)
    before = start(mesh, duty)
    for _ in range(12):
        after = stepped(mesh, duty, [before], 0.05)
        assert after is not None
        S = duty.seen(np.array([after.theta]))[0][0]
        assert kernel.borne(mesh, np.ones_like(after.P), after.P) == pytest.approx(tuple(S), rel=1e-4)
        assert (after.P * after.void).max() < 1e-6
        stored = ((after.oil - before.oil) @ mesh.width).sum() * np.pi / 48 / 0.05
        assert stored == pytest.approx(after.feed - after.side_flow, abs=2e-4)
        before = after


def test_nodes_see_the_edges_of_pockets_before_the_next_node() -> None:
    """Nodes every 10°, a pocket from -12° to 12°: the nodes at ±20° are 8° away from it."""
    mesh = supplied_mesh(0.5, 36, 4, (0.3,))
    held, ahead, behind = kernel.covered(mesh, np.array([[0.0, np.radians(12.0), 0.3]]))
    inside = mesh.zeta[:-1] <= 0.3
    assert (held[[35, 0, 1]][:, inside] == 1).all()
    assert held.sum() == 3 * inside.sum()
    assert ahead[34][inside] == pytest.approx(10 / 8 - 1)
    assert behind[2][inside] == pytest.approx(10 / 8 - 1)
    assert np.count_nonzero(ahead) == np.count_nonzero(behind) == inside.sum()
    assert kernel.covered(mesh, np.array([[1.0, np.pi, 0.3]]))[0][:, inside].min() == 1


def test_an_edge_feeds_as_the_straight_pressure_between_it_and_the_node() -> None:
    """Wherever the edge lies in the step, a node with P = 0 takes H³ (P_s − 0)/d for each unit of width."""
    mesh, e = supplied_mesh(0.5, 36, 4, (0.3,)), np.zeros(2)
    none, step = np.zeros((36, 4)), np.radians(10.0)
    for d in np.radians([0.5, 3.0, 9.9]):
        seen = kernel.covered(mesh, np.array([[0.0, 2 * step - d, 0.3]]))
        held = np.where(seen[0] > 0, 0.7, 0.0)  # at the pressure of the pocket
        *_, loss = kernel.balances(mesh, e, held, none + 1, seen, 0.7, 1.0, none)
        assert loss[0, 2, 0] == pytest.approx(-0.7 / d * mesh.width[0], rel=1e-3)


def test_angle_turned_is_the_integral_of_the_speed() -> None:
    """Exact for a speed linear between its angles; 0 at crank angle 0 wherever the cycle begins."""
    angle = np.array([-3.0, -2.0, -0.5, 0.7, 1.5, 2.4])
    turning = TurnedAngle(angle, 2 * np.pi, np.array([1.0, 3.0, -1.0, 0.5, 2.0, 1.0]))
    theta = np.linspace(-3, 12, 4001)
    speed = np.interp(theta, angle, turning.speed, period=2 * np.pi)
    by_sum = np.concatenate([[0], np.cumsum((speed[1:] + speed[:-1]) / 2 * np.diff(theta))])
    turned = turning(theta)
    assert turned - turned[0] == pytest.approx(by_sum, abs=1e-4)
    assert turning(np.array([0.0, 2 * np.pi])) == pytest.approx([0.0, turning.of_cycle], abs=1e-12)


def test_the_load_is_seen_from_the_mesh_and_the_hole_turns_with_the_journal() -> None:
    duty = constant(3.0, 0.5, 1.0)
    S, places = duty.seen(np.array([0.0, np.pi]))
    assert S == pytest.approx(np.array([[3.0, 0.0], [0.0, -3.0]]), abs=1e-12)
    assert places[:, 0, 0] == pytest.approx([2.0, 2.0 + np.pi / 2])


def test_the_load_between_its_angles_is_linear_and_repeats() -> None:
    """Also before the first angle, and where the angles of a cycle do not begin at 0."""
    angle = np.sort(np.random.default_rng(3).uniform(-2, 2 * np.pi - 2.01, 20))
    plain = constant(3.0, 0.5, 1.0)
    S = np.random.default_rng(4).normal(size=(2, 1, 20))
    load = replace(plain.load, angle=angle, S=S, w=np.zeros((1, 20)))
    duty = replace(plain, load=load, sliding=np.ones(20))
    theta = np.linspace(-20, 20, 500)
    wanted = [np.interp(theta, angle, line, period=2 * np.pi) for line in S[:, 0]]
    assert duty.seen(theta)[0] == pytest.approx(np.array(wanted).T, abs=1e-13)


def test_least_gap_lies_between_the_nodes_and_across_the_end_of_the_cycle() -> None:
    theta = np.linspace(0, 2 * np.pi, 61)[1:]
    for place in (1.0, 2 * np.pi - 0.03, 0.04):
        gap, angle = least_gap(theta, 1 - 0.9 * np.cos(theta - place), 2 * np.pi)
        assert gap == pytest.approx(0.1, rel=2e-3)
        assert (angle - place + np.pi) % (2 * np.pi) - np.pi == pytest.approx(0, abs=2e-3)


def test_a_film_that_is_squeezed_out_thins_and_a_settling_one_does_not() -> None:
    n = np.arange(1, EARLIEST + 1)
    assert thins(list(1 / n))
    assert thins(list(n**-0.5))
    assert not thins(list(0.1 + n**-0.5 / 5))
    assert not thins(list(1 / n[:-1]))
    assert not thins(list(0.1 + 0.2 * 0.8**n))
    assert not thins(list(0.1 + 0.01 * (-1.0) ** n))
    assert not thins(list(0.1 + 0.003 * np.random.default_rng(1).normal(size=n.size)))


@pytest.mark.parametrize(
    ("pocket", "pressure"),
    [
        (Pocket(0, 0.1, 0.3), 0.0), (Pocket(0, 0.1, 0.3), np.inf), (Pocket(0, 0.0, 0.3), 0.1),
        (Pocket(0, 3.2, 0.3), 0.1), (Pocket(0, 0.1, 0.0), 0.1), (Pocket(0, 0.1, 0.96), 0.1),
    ],
)  # fmt: skip
def test_a_supply_that_feeds_nothing_is_refused(pocket: Pocket, pressure: float) -> None:
    with pytest.raises(ValueError, match=r"pressure|half_"):
        Supply((pocket,), pressure)
    with pytest.raises(ValueError, match="at least one"):
        Supply((), 0.1)
