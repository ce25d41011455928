"""Ring and liner agree with other methods, and the elastic film with limits and balances."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_bvp
from scipy.optimize import brentq

from templates.physics.elastic.compliance import HARMONICS, liner_compliance, ring_compliance
from templates.physics.elastic.elastic_journal import (
    HOUSING,
    LINER,
    RIGID,
    Elasticity,
    elastic_film_at,
    measured,
    neglected_deformation,
    roelands_exponent,
)
from templates.physics.elastic.soft_balance import NoBalance, carried, rigid_balance, soft_balance
from templates.physics.elastic.soft_equations import Softness, modes
from templates.physics.films.film_map_inverse import mapped_eccentricity
from templates.physics.films.film_mesh import journal_mesh
from templates.physics.films.reynolds import static_field, static_film

STEEL, NU = 210e9, 0.3
STIFF = Softness(0.0, np.zeros(HARMONICS + 1))


def rigid(So, ratio, mesh=(64, 8)):
    eps = float(mapped_eccentricity(np.array(So), np.array(ratio)))
    return rigid_balance(So, ratio, eps, *mesh)


def soft(found, share, *, liner=1.0, ring=1.0, thick=(0.0, 0.0, 0.0)):
    """A softness that deforms the stiff film's bore by a share of its least gap."""
    compliance = ring_compliance(0.03, 0.045, STEEL, NU)
    film = found.film
    least, top = float(film.H.min()), float(film.P.max())
    probe = replace(film, softness=Softness(0.0, compliance), modes=modes(film.mesh, compliance))
    size = least / float(probe.deformation.max())
    return Softness(liner * share * least / top, ring * share * size * compliance, *thick)


class TestRing:
    def test_analytic_even_pressure_is_lamé(self):
        """Thick cylinder in plane strain, from Lamé's constants A − B/r² and Hooke's law at the bore."""
        a, b = 0.03, 0.05
        B = a**2 * b**2 / (b**2 - a**2)
        A = B / b**2
        hoop, radial = A + B / a**2, -1.0
        axial = NU * (hoop + radial)
        widening = a * (hoop - NU * (radial + axial)) / STEEL
        assert ring_compliance(a, b, STEEL, NU)[0] == pytest.approx(widening, rel=1e-12)

    @pytest.mark.parametrize("outer", [0.033, 0.045, 0.09])
    @pytest.mark.parametrize("n", [2, 3, 7])
    def test_second_method_ring_by_its_differential_equations(self, n, outer):
        """Equilibrium of u cos(n theta), v sin(n theta) in r by collocation; inside pressed, outside free."""
        a, b, mu = 0.03, outer, STEEL / (2 * (1 + NU))
        lam = STEEL * NU / ((1 + NU) * (1 - 2 * NU))

        def strains(r, y):  # y: u, v, radial stress, shear stress over mu
            u, v, radial, shear = y
            hoop = (u + n * v) / r
            rate = (radial * mu - lam * hoop) / (lam + 2 * mu)
            return hoop, rate, shear + (n * u + v) / r

        def slopes(r, y):
            hoop, rate, around = strains(r, y)
            of_hoop = (lam * (rate + hoop) + 2 * mu * hoop) / mu
            return np.stack([
                rate, around, -((y[2] - of_hoop) + n * y[3]) / r, (n * of_hoop - 2 * y[3]) / r,
            ])  # fmt: skip

        def ends(ya, yb):
            return np.array([ya[2] + 1, ya[3], yb[2], yb[3]])

        r = np.linspace(a, b, 200)
        found = solve_bvp(slopes, ends, r, np.zeros((4, r.size)), tol=1e-8, max_nodes=20_000)
        assert found.success
        assert ring_compliance(a, b, STEEL, NU)[n] * mu == pytest.approx(found.y[0, 0], rel=1e-6)

    def test_limit_high_harmonics_are_a_half_space(self):
        n = HARMONICS
        ring = ring_compliance(0.03, 0.06, STEEL, NU)
        # a free surface under p cos(k x) sinks by 2 (1 − nu²) p/(E k), k = n/a; besides a term of 1/n²
        assert ring[n] == pytest.approx(2 * (1 - NU**2) * 0.03 / (STEEL * n), rel=0.01)
        assert ring[1] == 0

    def test_property_thinner_rings_are_softer(self):
        compliance = ring_compliance(0.03, np.linspace(0.032, 0.09, 30), STEEL, NU)
        assert (np.diff(compliance[:, [0, 2, 3, 10]], axis=0) < 0).all()
        assert np.isnan(ring_compliance(0.03, np.array([0.02, np.nan]), STEEL, NU)).all()

    def test_limit_liner_without_sideways_strain(self):
        assert liner_compliance(1e-3, 50e9, 0.0) == pytest.approx(2e-14)
        assert liner_compliance(1e-3, 50e9, 0.5) == 0

    def test_second_method_deformation_by_the_fine_sum(self):
        """Of a hump of pressure about the narrowest gap: harmonics by a fine rule instead of the mesh's."""
        compliance = ring_compliance(0.03, 0.045, STEEL, NU)
        mesh = rigid(1.0, 0.5).film.mesh

        def hump(phi):
            return np.where(np.abs(phi + 0.3) < 0.8, np.cos(np.pi * (phi + 0.3) / 1.6) ** 2, 0.0)

        P = hump(mesh.phi)[:, None] * (1 - mesh.zeta**2)
        softness = Softness(0.0, compliance)
        found = replace(
            rigid(1.0, 0.5).film, softness=softness, modes=modes(mesh, compliance), P=P
        ).deformation[:, 0]
        fine = np.linspace(-np.pi, np.pi, 20_001)[:-1]
        sizes = [2 / 3 * (hump(fine) * np.exp(-1j * n * fine)).mean() * (2 if n else 1) for n in range(41)]
        wanted = sum(
            c * (a * np.exp(1j * n * mesh.phi)).real
            for n, (c, a) in enumerate(zip(compliance, sizes, strict=True))
        )
        np.testing.assert_allclose(found, wanted, atol=2e-3 * np.abs(wanted).max())


class TestSoftFilm:
    @pytest.mark.parametrize(("So", "ratio"), [(0.3, 0.5), (10.0, 1.0)])
    def test_limit_stiff_is_the_rigid_solver_on_the_same_mesh(self, So, ratio):
        """Where nothing gives way: the pressure of `static_field`, node by node, and its measures."""
        found = rigid(So, ratio)
        eps = found.film.eps
        field = static_field(eps, ratio, 64, 8)
        mesh = journal_mesh(eps, ratio, 64, 8)
        film = replace(found.film, mesh=mesh, modes=modes(mesh, STIFF.ring), P=field.rupture.P)
        assert np.abs(film.loss[field.rupture.film]).max() < 1e-11 * np.abs(film.loss).max()
        np.testing.assert_allclose(film.loss, field.equations.residual(field.rupture.P), atol=1e-9)
        there, here = static_film(eps, ratio, 64, 8), measured(film)
        for name, wanted in (("P_max", there.P_max), ("side_flow", there.side_flow),
                             ("attitude", there.attitude)):  # fmt: skip
            assert here[name] == pytest.approx(wanted, rel=1e-9), name
        assert here["load_couple"] == pytest.approx(eps * there.So * np.sin(there.attitude) / 2, rel=3e-3)
        assert measured(found.film)["shear"] == pytest.approx(np.pi / np.sqrt(1 - eps**2), rel=1e-4)

    def test_property_slopes_are_those_of_the_loss(self):
        """The matrix, the ring's columns and that of eps, by differences."""
        found = rigid(2.0, 0.6, (16, 6))
        film = soft_balance(2.0, soft(found, 0.5, thick=(5.0, 0.01, 0.6)), found).film
        inside = np.zeros(film.P.shape, bool)
        inside[1:-1, :-1] = True
        matrix, modal, by_eps = film.jacobian(inside)
        rng = np.random.default_rng(5)
        dP = np.where(inside, rng.normal(size=film.P.shape), 0.0)
        step = 1e-6
        ahead, back = (replace(film, P=film.P + s * dP).loss for s in (step, -step))
        slope = (ahead - back)[inside] / (2 * step)
        own = (matrix @ dP.ravel() + modal @ (film.amplitudes_of @ dP.ravel())).reshape(film.P.shape)
        np.testing.assert_allclose(own[inside], slope, atol=1e-5 * np.abs(slope).max())
        ahead, back = (replace(film, eps=film.eps + s).loss for s in (step, -step))
        slope = (ahead - back)[inside] / (2 * step)
        np.testing.assert_allclose(
            by_eps.reshape(inside.shape)[inside], slope, atol=1e-5 * np.abs(slope).max()
        )

    @pytest.mark.parametrize("share", [0.3, 2.0])
    @pytest.mark.parametrize("parts", [{"ring": 0.0}, {"liner": 0.0}, {"thick": (5.0, 0.005, 0.6)}])
    def test_property_load_and_flow_are_balanced(self, share, parts):
        found = rigid(3.0, 0.5)
        after = soft_balance(3.0, soft(found, share, **parts), found)
        film = after.film
        assert np.hypot(*film.force) == pytest.approx(3.0, rel=1e-8)
        assert (film.P >= 0).all()
        inside = after.inside
        carried_on = np.abs(film.loss).max()
        assert np.abs(film.loss[inside]).max() < 1e-7 * carried_on
        outside = ~inside
        outside[[0, -1]], outside[:, -1] = False, False
        assert (film.loss[outside] > -1e-9 * carried_on).all()  # where there is no film, none would form

    @pytest.mark.parametrize("parts", [{"ring": 0.0}, {"liner": 0.0}])
    def test_convergence_on_finer_meshes(self, parts):
        found = rigid(3.0, 0.5)
        softness = soft(found, 2.0, **parts)
        after = soft_balance(3.0, softness, found)
        gaps = [after.film.H.min()]
        for mesh in ((128, 16), (256, 32)):
            after = carried(after, 3.0, *mesh)
            gaps.append(after.film.H.min())
        first, second = np.abs(np.diff(gaps)) / gaps[-1]
        assert first < 5e-3
        assert second < 0.7 * first

    def test_second_method_soft_long_bearing_in_one_dimension(self):
        """B/D 40 with a liner: the film integrated along phi from trial flows to Swift's end of it."""
        ratio, So = 40.0, 2.0
        found = rigid(So, ratio, (128, 16))
        after = soft_balance(So, soft(found, 0.5, ring=0.0), found)
        film = after.film
        eps, per_P = film.eps, film.softness.liner
        phi = np.linspace(-np.pi, np.pi, 8001)

        def pressure(flow):
            """P along phi with dP/dphi = 6 (H − H_end)/H³, until it falls to 0 again."""
            P = np.zeros_like(phi)
            step = phi[1] - phi[0]
            for k in range(phi.size - 1):

                def slope(at, p):
                    H = 1 - eps * np.cos(at) + per_P * p
                    return 6 * (H - flow) / H**3

                first = slope(phi[k], P[k])
                P[k + 1] = P[k] + step * slope(phi[k] + step / 2, P[k] + step / 2 * first)
                if P[k + 1] < 0 or (phi[k] > 0 and 1 - eps * np.cos(phi[k]) > flow):
                    return P, P[k + 1]
            return P, P[-1]

        def left(flow):
            return pressure(flow)[1]

        flow = brentq(left, 1 - eps + 1e-3, 1.0, xtol=1e-7)
        assert pressure(flow)[0].max() == pytest.approx(film.P[:, 0].max(), rel=0.01)

    def test_property_what_cannot_be_borne_is_refused(self):
        found = rigid(1.0, 0.5)
        with pytest.raises(NoBalance):
            soft_balance(1.0, soft(found, 100.0, ring=0.0), found)


ETA, UNIT, CLEARANCE, RADIUS = 0.02, 1e7, 3e-5, 0.03


def elasticity(stiffness=1.0, **changes):
    values = {
        "liner": liner_compliance(0.5e-3, 50e9, 0.35) / stiffness, "inner": RADIUS, "outer": 0.05,
        "modulus": STEEL * stiffness, "poisson": NU, "exponent": 0.5 / stiffness, "eta": ETA,
        "pressure": UNIT, "clearance": CLEARANCE,
    }  # fmt: skip
    return Elasticity(**{name: np.asarray(value, float) for name, value in {**values, **changes}.items()})


class TestElasticJournal:
    @pytest.mark.parametrize("level", [LINER, HOUSING])
    @pytest.mark.parametrize("So", [0.2, 20.0])
    def test_limit_stiff_is_rigid(self, level, So):
        stiff = elastic_film_at(RIGID, So, 0.5, elasticity())
        near = elastic_film_at(level, So, 0.5, elasticity(1e8))
        for name in (
            "eps",
            "attitude",
            "least",
            "P_max",
            "peak",
            "shear",
            "load_couple",
            "side_flow",
            "thickening",
        ):
            assert getattr(near, name) == pytest.approx(getattr(stiff, name), rel=1e-6), name
        assert 0 < near.deformation < 1e-6

    def test_limit_thick_housing_leaves_its_liner(self):
        """A housing of a modulus without end deforms by its liner alone."""
        of_liner = elastic_film_at(LINER, 3.0, 0.5, elasticity())
        both = elastic_film_at(HOUSING, 3.0, 0.5, elasticity(modulus=STEEL * 1e8))
        assert both.least == pytest.approx(of_liner.least, rel=1e-6)

    def test_literature_roelands_at_a_hundred_megapascal(self):
        """Roelands' law by hand, and its slope at ambient pressure, which is the coefficient given."""
        Z = roelands_exponent(20e-9, ETA)
        size = np.log(ETA) + 9.67
        by_hand = np.exp(size * ((1 + 5.1e-9 * 1e8) ** Z - 1))
        softness = Softness(0.0, np.zeros(1), size, 5.1e-9 * UNIT, float(Z))
        eta, slope = softness.thickening(np.array([10.0, 0.0]))
        assert eta[0] == pytest.approx(by_hand, rel=1e-12)
        assert slope[1] == pytest.approx(20e-9 * UNIT, rel=1e-12)
        assert eta[0] < np.exp(20e-9 * 1e8)  # below Barus
        assert np.isnan(roelands_exponent(20e-9, 1e-5))
        assert roelands_exponent(0.0, 1e-5) == 0

    def test_property_thicker_oil_bears_more(self):
        plain = elastic_film_at(LINER, 3.0, 0.5, elasticity(exponent=0.0))
        thick = elastic_film_at(LINER, 3.0, 0.5, elasticity(exponent=0.5))
        assert plain.thickening == 1
        assert thick.thickening > 1
        assert thick.least > plain.least

    def test_property_estimate_of_what_is_neglected(self):
        """Where the deformation is small the estimate is at most 25 % above the solution, and not below."""
        rng = np.random.default_rng(3)
        for _ in range(12):
            So, ratio, wall = 10 ** rng.uniform(-1, 2), rng.uniform(0.2, 1.2), rng.uniform(1.15, 2.5)
            width = 2 * RADIUS * ratio
            body = elasticity(1e6, liner=0.0, outer=RADIUS * wall, exponent=0.0)
            solved = elastic_film_at(HOUSING, So, ratio, body)
            top = elastic_film_at(RIGID, So, ratio, body).P_max * UNIT
            load = So * UNIT * width * 2 * RADIUS
            estimate = neglected_deformation(
                RIGID, top, load, RADIUS, width, 0.0, RADIUS, RADIUS * wall, STEEL * 1e6, NU
            )
            assert 0.99 < estimate / (solved.deformation * CLEARANCE) < 1.25
            assert neglected_deformation(
                HOUSING, top, load, RADIUS, width, 0.0, RADIUS, RADIUS * wall, STEEL * 1e6, NU
            ) == 0  # fmt: skip

    def test_property_points_harm_no_other(self):
        So = np.array([0.0, 1.0, np.nan, 1e9])
        film = elastic_film_at(LINER, So, 0.5, elasticity())
        alone = elastic_film_at(LINER, 1.0, 0.5, elasticity())
        assert film.least[1] == alone.least
        assert film.eps[0] == 0
        assert film.deformation[0] == 0
        assert np.isnan(film.least[2])
        assert np.isinf(film.eps[3])
