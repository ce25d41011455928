"""Pads of infinite and finite width: against closed forms, the film solver of the journal, and balances."""

import numpy as np
import pytest
from finite_slider import finite_slider
from scipy.integrate import quad

from templates.physics.films.complementarity import rupture
from templates.physics.films.film_equations import film_equations, midpoints, rotation
from templates.physics.films.film_mesh import Mesh
from templates.physics.pads.pad_equations import solved_pads
from templates.physics.pads.pad_mesh import across, grading
from templates.physics.pads.slider_film import STATIONS, pad_film, shear_of_wedge, velocity_profile

RATIOS = [1 + 1e-9, 1.05, 2.0, 10.0, 300.0]
WIDTHS = [0.01, 0.3, 1.0, 10.0, 100.0]


def by_complementarity(a, width, n, m):
    """The same mesh, solved with rupture by the active set of the journal film."""
    x = grading(np.array(a), np.array(width)).place(np.linspace(0, 1, n + 1))
    mesh = Mesh(x, across(np.array(a), np.array(width), m), np.zeros(n + 1), np.zeros(m + 1))
    H, H_mid = a - (a - 1) * x, a - (a - 1) * midpoints(x)
    return rupture(film_equations(mesh, width / 2, H, H_mid, rotation(H_mid)))


class TestLiterature:
    def test_literature_infinite_pad(self):
        """References README: film ratio 2 → 0.02648051, best 2.1889 → 0.02670719."""
        result = pad_film("infinite", np.array([2.0, 2.1889]), 1.0).load
        assert result == pytest.approx([0.02648051, 0.02670719], abs=5e-9)

    @pytest.mark.parametrize("width", [1.0, 0.5, 2.0])
    def test_analytic_leakage_is_that_of_the_journal_solver(self, width):
        """The second solver, which errs by 0.02 % at 128 × 32."""
        assert pad_film("finite", 2.0, width).load == pytest.approx(finite_slider(2.0, width).load, rel=3e-4)


class TestAnalytic:
    @pytest.mark.parametrize("a", [1.05, 2.0, 50.0])
    @pytest.mark.parametrize("width", WIDTHS)
    def test_analytic_separation_solves_the_same_balances(self, a, width):
        P = solved_pads(np.array([a]), np.array([width]), 24, 8)[1][0]
        full = by_complementarity(a, width, 24, 8)
        assert full.film[1:-1, :-1].all()
        np.testing.assert_allclose(6 * P, full.P[:, 0], rtol=1e-7, atol=1e-10 * full.P.max())

    @pytest.mark.parametrize("a", [1.0, 0.999, 0.3])
    def test_analytic_diverging_film_is_ruptured_everywhere(self, a):
        x, zeta = np.linspace(0, 1, 17), np.linspace(0, 1, 9)
        H, H_mid = a - (a - 1) * x, a - (a - 1) * midpoints(x)
        mesh = Mesh(x, zeta, np.zeros(17), np.zeros(9))
        assert (rupture(film_equations(mesh, 0.5, H, H_mid, rotation(H_mid))).P == 0).all()
        film = pad_film("finite", a, 1.0)
        assert (film.load, film.P_max, film.side_flow) == (0, 0, 0)
        assert np.isnan(film.centre)
        assert film.inlet_flow == pytest.approx(a / 2)

    @pytest.mark.parametrize("a", [0.2, 0.9])
    def test_analytic_streamers_shear_by_what_they_fill(self, a):
        def sheared(x):
            return a / (a - (a - 1) * x) ** 2

        assert shear_of_wedge(np.array(a)) == pytest.approx(quad(sheared, 0, 1)[0])

    @pytest.mark.parametrize("a", [1.2, 2.0, 10.0])
    @pytest.mark.parametrize("width", [0.2, 1.0, 20.0])
    def test_analytic_order_of_convergence(self, a, width):
        """Observed order of load and moment; the flows have the corners' logarithm, h² ln h."""
        pads = np.array([a]), np.array([width])
        coarse, medium, fine = (solved_pads(*pads, n, n // 4)[0][0] for n in (32, 64, 128))
        order = np.log2((medium - coarse)[:2] / (fine - medium)[:2])
        assert (order > 1.8).all()

    @pytest.mark.parametrize("a", RATIOS)
    @pytest.mark.parametrize("width", WIDTHS)
    def test_analytic_extrapolated_is_converged(self, a, width):
        pads = np.array([a]), np.array([width])
        medium, fine = (solved_pads(*pads, n, n // 4)[0][0] for n in (128, 256))
        best, film = fine + (fine - medium) / 3, pad_film("finite", *pads)
        assert film.load == pytest.approx(best[0], rel=2e-4)
        assert film.centre == pytest.approx(best[1] / best[0], abs=1e-4)
        assert film.inlet_flow == pytest.approx(best[2], rel=2e-3)

    @pytest.mark.parametrize("a", [1 + 1e-9, 1.05, 2.0])
    def test_analytic_narrow_pad(self, a):
        """Without flow along it p = 3 eta U (h_i − h_o)/l (b²/4 − z²)/h³; what is missing falls as b/l."""
        width = np.array([0.02, 0.01])
        short = (a - 1) * (a + 1) / (24 * a**2) * width**2
        missing = 1 - pad_film("finite", a, width).load / short
        assert missing[1] == pytest.approx(0, abs=0.02)
        assert missing[0] / missing[1] == pytest.approx(2, rel=0.02)

    @pytest.mark.parametrize("a", [1.05, 2.0, 10.0])
    def test_analytic_wide_pad_tends_to_the_closed_form(self, a):
        """What is missing falls as l/b: twice the width, half of it."""
        width = np.array([25.0, 50.0, 100.0])
        finite, infinite = pad_film("finite", a, width), pad_film("infinite", a, width)
        missing = 1 - finite.load / infinite.load
        assert missing[:-1] / missing[1:] == pytest.approx([2, 2], rel=2e-3)
        assert finite.P_max == pytest.approx(infinite.P_max, rel=5e-5)
        assert finite.centre == pytest.approx(infinite.centre, abs=2e-3)
        assert finite.peak == pytest.approx(infinite.peak, abs=2e-4)
        np.testing.assert_allclose(
            finite.pressure(STATIONS), infinite.pressure(STATIONS), atol=1e-5 * infinite.P_max.max()
        )

    @pytest.mark.parametrize("a", RATIOS)
    @pytest.mark.parametrize("width", WIDTHS)
    def test_analytic_balance_of_flow(self, a, width):
        """What enters and does not leave at the outlet leaves at the sides."""
        _, _, inlet, side = solved_pads(np.array([a]), np.array([width]), 32, 8)[0][0]
        x = grading(np.array(a), np.array(width)).place(np.linspace(0, 1, 33))
        full = by_complementarity(a, width, 32, 8)
        mesh = Mesh(x, across(np.array(a), np.array(width), 8), np.zeros(33), np.zeros(9))
        middle = midpoints(x)
        equations = film_equations(
            mesh, width / 2, a - (a - 1) * x, a - (a - 1) * middle, rotation(a - (a - 1) * middle)
        )
        outlet = -float(equations.residual(full.P)[-1].sum()) / 12
        assert inlet - outlet == pytest.approx(side, rel=1e-6, abs=1e-12)

    @pytest.mark.parametrize("level", ["infinite", "finite"])
    def test_analytic_forces_on_pad_and_runner_balance(self, level):
        """Friction on the runner less that on the pad is the pressure's part along the incline."""
        film = pad_film(level, np.array(RATIOS), 2.0)
        along = 6 * film.load * (film.a - 1)
        assert film.friction_moving - film.friction_fixed == pytest.approx(along)

    @pytest.mark.parametrize("level", ["infinite", "finite"])
    @pytest.mark.parametrize("a", [1.05, 2.0, 10.0])
    def test_analytic_gradient_is_the_slope_of_the_pressure(self, level, a):
        film, step = pad_film(level, a, 1.5), 1e-4
        for x in (0.11, 0.5, 0.83):
            before, after = film.pressure(np.array([x - step, x + step]))
            assert film.gradient(np.array(x)) == pytest.approx(6 * (after - before) / (2 * step), rel=1e-3)

    def test_analytic_velocity_meets_both_faces_and_carries_the_flow(self):
        """u(0) = 0, u(h) = u_a, and the mean is u_a/2 − h² p'/(12 eta)."""
        h, slope, eta, u_a = 2e-5, -3e8, 0.02, 3.0
        u = velocity_profile(*(np.float64(value) for value in (h, slope, eta, u_a)))
        assert u[[0, -1]] == pytest.approx([0, u_a])
        exact = u_a / 2 - h**2 * slope / (12 * eta)
        assert np.trapezoid(u, dx=1 / 40) == pytest.approx(exact, rel=1e-3)

    @pytest.mark.parametrize("level", ["infinite", "finite"])
    def test_analytic_flow_of_a_wide_pad_is_the_same_everywhere(self, level):
        film = pad_film(level, 3.0, 100.0)
        x = np.linspace(0.05, 0.95, 7)
        H = 3.0 - 2.0 * x
        flow = [
            H_x / 2 - H_x**3 / 12 * film.gradient(np.array(place)) for H_x, place in zip(H, x, strict=True)
        ]
        assert flow == pytest.approx([0.75] * 7, rel=1e-4)


class TestProperty:
    @pytest.mark.parametrize("level", ["infinite", "finite"])
    def test_property_extremes_are_finite_and_bounded(self, level):
        """10⁴ pads over the whole range: finite, nothing negative, finite width bears less."""
        rng = np.random.default_rng(11)
        a = np.concatenate([10 ** rng.uniform(-3, 3, 8000), 1 + 10 ** rng.uniform(-15, 0, 2000)])
        width = 10 ** rng.uniform(-2, 2, a.size)
        film = pad_film(level, a, width)
        bears = a > 1
        assert ((film.load > 0) == bears).all()
        assert (film.load <= pad_film("infinite", a, width).load * (1 + 1e-4)).all()
        for name in ("centre", "peak"):
            place = getattr(film, name)
            assert (np.isnan(place) == ~bears).all()
            assert ((place[bears] > 0) & (place[bears] < 1)).all()
        for value in (film.P_max, film.inlet_flow, film.side_flow, film.pressure(STATIONS)):
            assert np.isfinite(value).all()
            assert (value >= -1e-12).all()
        assert np.isfinite(film.friction_fixed).all()
        assert (film.friction_moving > 0).all()
        assert np.isfinite(film.gradient(rng.uniform(0, 1, a.size))).all()
        reported = film.pressure(STATIONS).max(axis=1)
        assert (reported <= film.P_max * (1 + 1e-3)).all()

    def test_property_load_rises_with_width(self):
        width = np.geomspace(0.01, 100, 400)
        for a in RATIOS:
            load = pad_film("finite", a, width).load
            assert (np.diff(load) > -1e-4 * load[1:]).all()

    @pytest.mark.parametrize(
        ("a", "width", "words"),
        [(0, 1, "film ratio"), (-2, 1, "film ratio"), (1001, 1, "film ratio"), (2, 0.001, "width"),
         (2, 101, "width"), (2, np.inf, "width")],
    )  # fmt: skip
    def test_property_refused_by_name(self, a, width, words):
        with pytest.raises(ValueError, match=words):
            pad_film("finite", a, width)

    def test_property_not_a_number_harms_no_other(self):
        film = pad_film("finite", np.array([2.0, np.nan, 2.0]), np.array([1.0, 1.0, np.nan]))
        alone = pad_film("finite", 2.0, 1.0)
        assert film.load[0] == pytest.approx(float(alone.load), rel=1e-14)
        assert np.isnan(film.load[1:]).all()
        assert np.isnan(film.friction_moving[1:]).all()
        assert np.isnan(film.pressure(STATIONS)[1:]).all()
