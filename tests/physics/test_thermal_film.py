"""The thermal film agrees with integrals across, balances of oil and heat, Couette flow, and limits."""

from dataclasses import replace

import numpy as np
import pytest

from templates.physics.thermal.across import across, strip_edges
from templates.physics.thermal.anderson import Anderson
from templates.physics.thermal.arc import groove_arc
from templates.physics.thermal.bearing_place import NoBalance
from templates.physics.thermal.energy import HeatSources, carried, heated
from templates.physics.thermal.pressure import gap_of, pressed
from templates.physics.thermal.thermal_balance import Bearing, both, one_temperature, warm

SUPPLY = 313.15  # K
GROOVE = (np.pi, np.radians(20), 0.8)
HEATING = HeatSources(delta=1.0, kappa=0.03, wall=0.0, outside=SUPPLY, supply=SUPPLY, journal=np.nan)
TINY, SMALL = (24, 4, 8), (48, 8, 12)


def thinning(T):
    """3 % a kelvin."""
    return np.exp(0.03 * (T - SUPPLY))


BEARING = Bearing(So=1.0, ratio=0.8, pressure=0.1, groove=GROOVE, heating=HEATING, fluidity=thinning)


def solved(bearing, mesh=TINY):
    placing = bearing.placing(bearing.start(), mesh)
    return warm(bearing, placing, np.full((mesh[0] + 1, mesh[2]), SUPPLY + 5))


@pytest.fixture(scope="module")
def thin():
    """A film that is warm, thin and ruptured."""
    return solved(replace(BEARING, So=3.0))


class TestAcross:
    def test_even_viscosity_is_the_reynolds_equation(self):
        parts = across(np.ones((3, 7)), strip_edges(7))
        assert parts.conductance == pytest.approx(1 / 12, rel=1e-13)
        assert parts.carried == pytest.approx(1 / 2, rel=1e-13)
        assert parts.shear == pytest.approx(1, rel=1e-13)

    def test_strips_carry_what_the_film_carries(self):
        parts = across(np.exp(np.random.default_rng(1).normal(size=(5, 9))), strip_edges(9))
        assert parts.by_pressure.sum(axis=1) == pytest.approx(-parts.conductance, rel=1e-12)
        assert parts.by_drag.sum(axis=1) == pytest.approx(parts.carried, rel=1e-12)
        assert parts.heat_of_both.sum(axis=1) == pytest.approx(0, abs=1e-13)
        assert (parts.by_pressure < 0).all()

    def test_two_layers_by_hand(self):
        """Fluidity 1 below and 3 above the middle: F_0 2, F_1 1/8 + 9/8, F_2 1/24 + 21/24 − F_1²/F_0."""
        edges = np.linspace(0, 1, 5)
        parts = across(np.array([[1.0, 1, 3, 3]]), edges)
        F_1 = 1 / 8 + 9 / 8
        assert parts.shear[0] == pytest.approx(1 / 2, rel=1e-14)
        assert parts.carried[0] == pytest.approx(1 - F_1 / 2, rel=1e-14)
        assert parts.conductance[0] == pytest.approx(22 / 24 - F_1**2 / 2, rel=1e-14)
        # dragged alone: speed 1/2 Y below, so 1/2 · (1/2)²/2 flows there
        assert parts.by_drag[0, :2].sum() == pytest.approx(1 / 16, rel=1e-14)


class TestBalances:
    def test_the_power_put_in_is_dissipated(self, thin):
        """Torque times speed, and the work of the groove's pressure, is the heat."""
        film = thin.film
        gap, arc = film.gap, film.gap.arc
        along = -(gap.H_faces**3 * gap.faces.conductance / np.diff(arc.phi))[:, None] * np.diff(
            film.P, axis=0
        )
        along = along + (gap.H_faces * gap.faces.carried)[:, None] * (1 - film.void[:-1])
        fed = ((along[0] - along[-1]) * gap.fed) @ arc.across
        assert fed > 0
        assert carried(film).heat.sum() == pytest.approx(film.torque + fed, rel=1e-12)

    def test_what_leaves_at_the_ends_is_what_pressure_drives_there(self, thin):
        film = thin.film
        gap, arc = film.gap, film.gap.arc
        slope = (film.P[:, -2] - film.P[:, -1]) / np.diff(arc.zeta)[-1]
        out = gap.nodes.conductance * gap.H_nodes**3 * arc.around / arc.ratio**2 * slope
        side = carried(film).side.sum(axis=1)
        # the cells at the ends have half of what shear brings there besides
        assert side.sum() == pytest.approx(out[1:-1].sum(), rel=0.1)
        ruptured = (film.P[:, -2] <= 0)[1:-1]
        assert ruptured.sum() > 4
        assert side[ruptured][1:-1] == pytest.approx(0, abs=1e-12)

    def test_strips_keep_their_oil(self, thin):
        flow = carried(thin.film)
        gain = flow.around[:-1] - flow.around[1:] - flow.side
        above = np.pad(flow.up, ((0, 0), (1, 1)))
        assert gain - np.diff(above, axis=1) == pytest.approx(0, abs=1e-13)

    @pytest.mark.parametrize(
        "change",
        [
            {}, {"wall": 0.02, "outside": SUPPLY - 10}, {"wall": np.inf, "outside": SUPPLY + 30},
            {"journal": SUPPLY + 20.0}, {"carry_over": 0.5},
        ],
    )  # fmt: skip
    def test_heat_that_arises_leaves(self, thin, change):
        heating = replace(HEATING, **change)
        found = heated(thin.film, heating, strip_edges(TINY[2]))
        assert abs(found.residual) < 1e-10
        assert (found.by_drain > 0) == (heating.carry_over < 1)
        assert (found.by_bush != 0) == (heating.wall > 0)
        if np.isnan(heating.journal):
            assert found.by_journal == pytest.approx(0, abs=1e-9)
        else:
            assert found.journal == pytest.approx(SUPPLY + 20)
        if np.isinf(heating.wall):
            assert found.bush[1:-1] == pytest.approx(SUPPLY + 30)

    def test_nothing_is_colder_than_the_coldest_around(self, thin):
        heating = replace(HEATING, wall=0.05, outside=SUPPLY - 20)
        found = heated(thin.film, heating, strip_edges(TINY[2]))
        assert found.T.min() > SUPPLY - 20
        assert found.bush.min() > SUPPLY - 20

    def test_the_groove_mixes(self, thin):
        """Its oil: what arrives at its temperature, and fresh oil."""
        flow, found = carried(thin.film), thin.heated
        arriving = flow.around[-1]
        assert (arriving > 0).any()
        entering = flow.around[0].clip(0).sum() + (-arriving).clip(0).sum()
        warm_oil = arriving.clip(0) @ found.T[-2] + (-flow.around[0]).clip(0) @ found.T[1]
        assert found.groove * entering == pytest.approx(warm_oil + found.fresh * SUPPLY, rel=1e-12)
        assert SUPPLY < found.groove < found.T.max()

    def test_without_carry_over_the_film_begins_with_fresh_oil(self, thin):
        found = heated(thin.film, replace(HEATING, carry_over=0.0), strip_edges(TINY[2]))
        assert found.groove == pytest.approx(SUPPLY, rel=1e-12)


def couette(fluidity, strips):
    """A concentric film without pressure."""
    arc = groove_arc(0.1, 6.0, (0.0, 0.0), 1.0, 16, 4)
    return pressed(gap_of(arc, np.zeros(2), fluidity, strip_edges(strips), (0.0, 0.8)))


class TestCouette:
    def test_between_walls_of_one_temperature_it_is_a_parabola(self):
        """T − T_0 = (eta U²/2k) Y (1 − Y), where conduction rules."""
        errors = []
        for strips in (8, 16):
            film = couette(np.ones((17, strips)), strips)
            heating = HeatSources(200.0, 100.0, np.inf, SUPPLY, SUPPLY, SUPPLY)
            T = heated(film, heating, strip_edges(strips)).T[-3]
            edges = strip_edges(strips)
            Y = (edges[1:] + edges[:-1]) / 2
            errors.append(np.abs(T - SUPPLY - Y * (1 - Y)).max())
        assert errors[0] < 0.02
        assert errors[1] < errors[0] / 3

    def test_an_adiabatic_film_warms_by_twice_delta_a_radian(self):
        """rho c (U h/2) dT/dx = eta U²/h for the flow's mean temperature."""
        film = couette(np.ones((17, 8)), 8)
        heating = HeatSources(0.7, 0.05, 0.0, SUPPLY, SUPPLY, np.nan, carry_over=0.0)
        found = heated(film, heating, strip_edges(8))
        assert carried(film).side == pytest.approx(0, abs=1e-13)
        assert found.by_drain / 0.5 == pytest.approx(2 * 0.7 * 6.0, rel=1e-10)

    @pytest.mark.parametrize("nahme", [1.0, 20.0])
    def test_exponential_viscosity_between_equal_walls(self, nahme):
        """Nahme 1940; Gavis, Laurence 1968: beta (T_max − T_0) = ln(1 + Na/8), and the shear stress."""
        beta, kappa, strips = 0.05, 400.0, 48
        heating = HeatSources(kappa * nahme / beta, kappa, np.inf, SUPPLY, SUPPLY, SUPPLY)
        T, search = np.full((17, strips), SUPPLY), Anderson()
        for _ in range(60):
            film = couette(np.exp(beta * (T - SUPPLY)), strips)
            change = heated(film, heating, strip_edges(strips)).T - T
            if np.abs(change).max() < 1e-8:
                break
            T = np.clip(search.after(T, change), SUPPLY, SUPPLY + 200)
        top = beta * (T[-3].max() - SUPPLY)
        assert top == pytest.approx(np.log(1 + nahme / 8), rel=3e-3)
        stress = np.arcsinh(np.sqrt(nahme / 8)) / np.sqrt(nahme / 8 * (1 + nahme / 8))
        assert film.gap.nodes.shear[-3] == pytest.approx(stress, rel=3e-3)


class TestLimits:
    def test_viscosity_that_does_not_change_is_the_isothermal_film(self):
        bearing = replace(BEARING, fluidity=np.ones_like)
        found = solved(bearing)
        alone = bearing.placing(bearing.start(), TINY)
        film = alone.placed(np.ones((TINY[0] + 1, TINY[2])), 1e-10)
        assert found.film.gap.eps == pytest.approx(film.gap.eps, rel=1e-7)
        assert found.film.P == pytest.approx(film.P, rel=1e-6, abs=1e-9)
        assert found.heated.T.max() > SUPPLY + 5

    @pytest.mark.parametrize(("kappa", "within"), [(1e3, 2e-3), (1e5, 2e-5)])
    def test_walls_at_the_supply_s_temperature_that_take_all_heat(self, kappa, within):
        """With conduction without limit the film is the isothermal one, and the difference falls as 1/k."""
        cold = replace(HEATING, kappa=kappa, wall=np.inf, journal=SUPPLY)
        found = solved(replace(BEARING, heating=cold))
        even = solved(replace(BEARING, fluidity=np.ones_like, heating=cold))
        assert found.film.gap.eps == pytest.approx(even.film.gap.eps, rel=within)
        assert found.heated.T.max() - SUPPLY < 200 / kappa

    def test_much_heat_transfer_is_a_held_bush(self):
        held = solved(replace(BEARING, heating=replace(HEATING, wall=np.inf)))
        cooled = solved(replace(BEARING, heating=replace(HEATING, wall=1e6)))
        assert cooled.film.gap.eps == pytest.approx(held.film.gap.eps, rel=1e-5)
        assert cooled.heated.bush == pytest.approx(held.heated.bush, abs=1e-3)

    def test_no_heat_transfer_is_an_adiabatic_bush(self):
        adiabatic = solved(BEARING)
        little = solved(replace(BEARING, heating=replace(HEATING, wall=1e-9)))
        assert little.heated.T == pytest.approx(adiabatic.heated.T, rel=1e-7)

    def test_one_temperature_meets_its_own_balance(self):
        placing = BEARING.placing(BEARING.start(), TINY)
        found = one_temperature(BEARING, placing, SUPPLY, 30.0)
        flow = carried(found.film)
        outlet = 2 * found.T - SUPPLY
        assert flow.side.sum() * (outlet - SUPPLY) == pytest.approx(flow.heat.sum(), rel=1e-7)

    def test_a_groove_turned_by_a_turn_is_the_same(self):
        first = solved(BEARING)
        again = solved(replace(BEARING, groove=(GROOVE[0] - 2 * np.pi, *GROOVE[1:])))
        assert again.film.gap.eps == pytest.approx(first.film.gap.eps, rel=1e-6)
        assert again.heated.T == pytest.approx(first.heated.T, rel=1e-6)

    @pytest.mark.parametrize(
        "change",
        [
            {"groove": (0.0, np.radians(20), 0.8), "pressure": 0.0, "So": 5.0},  # in the load line
            {"So": 1e-9, "pressure": 0.0},  # so light that no oil leaves
            {"So": 1e9},
            {"heating": replace(HEATING, delta=1e7), "fluidity": np.ones_like},
        ],
    )
    def test_what_has_no_film_is_refused_by_name(self, change):
        with pytest.raises(NoBalance):
            both(replace(BEARING, **change), "field")


def test_the_mesh_converges():
    films = [solved(BEARING, (12 * k, 2 * k, 4 * k)) for k in (2, 4, 8)]
    least = [1 - found.film.gap.eps for found in films]
    hottest = [found.heated.journal for found in films]
    assert abs(least[2] - least[1]) < 0.65 * abs(least[1] - least[0])
    assert abs(least[2] - least[1]) < 0.005 * least[2]
    assert abs(hottest[2] - hottest[1]) < 0.02 * (hottest[2] - SUPPLY)


class TestAnderson:
    def test_it_ends_where_a_plain_iteration_runs_away(self):
        matrix = np.array([[-2.0, 0.3], [0.1, -1.5]])
        x, search = np.zeros(2), Anderson()
        for _ in range(12):
            change = matrix @ x + 1 - x
            if np.abs(change).max() < 1e-12:
                break
            x = search.after(x, change)
        assert x == pytest.approx(np.linalg.solve(np.eye(2) - matrix, np.ones(2)), rel=1e-10)
