"""Analytic: closed forms, meshes and rules of the films agree with second methods or limits."""

import numpy as np
import pytest
from scipy.integrate import quad

from templates.physics.films.film_mesh import gap, graded_across, gregory, halved, journal_mesh, ring_mesh
from templates.physics.films.film_mesh import sommerfeld_angle as sommerfeld
from templates.physics.films.long_bearing import rupture_Swift_Stieber
from templates.physics.films.short_dynamics import coefficients_Holmes_1960
from templates.physics.journals.lubrication_regime import (
    duty_parameter,
    film_parameter,
    friction_coefficient,
    lubrication_regime,
)
from templates.physics.journals.smallest_film import smallest_film_ISO_7902
from templates.physics.journals.whirl import threshold_mass, whirl_ratio_squared, whirl_stiffness
from templates.physics.pads.pad_mesh import across, grading


def short_force(e, speed):
    """Force of the short half film on a journal at e that moves so fast, up to a factor.

    p goes with -(dH/dtheta + 2 dH/dt)/H³ where that is positive; it pushes the journal off the wall.
    """
    theta = (np.arange(200_000) + 0.5) * (2 * np.pi / 200_000)
    way = np.stack([np.cos(theta), np.sin(theta)])
    H, by_angle = 1 - e @ way, e[0] * way[1] - e[1] * way[0]
    p = np.maximum(-(by_angle - 2 * (speed @ way)) / H**3, 0)
    return -(way * p).mean(axis=1)


@pytest.mark.parametrize("eps", [0.15, 0.5, 0.85])
def test_short_coefficients_are_slopes_of_the_force(eps):
    still, centre = np.zeros(2), np.array([eps, 0.0])
    film = short_force(centre, still)
    load = np.hypot(*film)
    turn = np.array([-film, [film[1], -film[0]]]) / load  # x along the load, y ahead of it
    step = 1e-4
    slopes = [
        np.stack(
            [
                (short_force(centre + a * d, b * d) - short_force(centre - a * d, -b * d)) / 2
                for d in np.eye(2)
            ],
            axis=1,
        )
        for a, b in ((step, 0), (0, step))
    ]
    for closed, slope in zip(coefficients_Holmes_1960(eps), slopes, strict=True):
        assert closed == pytest.approx(turn @ (-slope / step / load) @ turn.T, rel=2e-3, abs=2e-3)


def eigenvalues(K, B, M):
    """Of M e'' + B e' + K e = 0."""
    zero, one = np.zeros((2, 2)), np.eye(2)
    return np.linalg.eigvals(np.block([[zero, one], [-K / M, -B / M]]))


@pytest.mark.parametrize("seed", range(6))
def test_a_rotor_whirls_from_the_threshold_mass_on(seed):
    """Random films, damping not symmetric: the eigenvalues of the motion cross over at that mass."""
    rng = np.random.default_rng(seed)
    K = np.array([[2.0, 4.0], [-3.0, 2.5]]) * rng.uniform(0.7, 1.3, (2, 2))
    B = np.array([[5.0, 1.0], [2.0, 4.0]]) * rng.uniform(0.7, 1.3, (2, 2))
    mass, ratio = float(threshold_mass(K, B)), float(whirl_ratio_squared(K, B))
    at = eigenvalues(K, B, mass)
    fastest = at[np.argmax(at.real)]
    assert fastest.real == pytest.approx(0, abs=1e-9)
    assert abs(fastest.imag) == pytest.approx(np.sqrt(ratio))
    assert eigenvalues(K, B, 0.99 * mass).real.max() < 0 < eigenvalues(K, B, 1.01 * mass).real.max()
    assert float(whirl_stiffness(K, B)) == pytest.approx(mass * ratio)


def test_without_coupling_no_mass_whirls():
    K, B = np.diag([2.0, 3.0]), np.diag([4.0, 5.0])
    assert threshold_mass(np.stack([K, K]), np.stack([B, B])).tolist() == [np.inf, np.inf]


class TestFilmMeshes:
    @pytest.mark.parametrize("n", [6, 7, 20])
    def test_gregory_is_exact_for_cubics(self, n):
        x = np.arange(n + 1)
        for power in range(4):
            assert gregory(n) @ x**power == pytest.approx(n ** (power + 1) / (power + 1))

    def test_fewer_than_six_intervals_are_refused(self):
        with pytest.raises(ValueError, match="at least 6"):
            gregory(5)

    @pytest.mark.parametrize("eps", [0.0, 0.3, 0.999])
    def test_sommerfelds_angle_by_its_definition(self, eps):
        phi = np.linspace(-3.1, 3.1, 41)
        gamma = sommerfeld(phi, eps)
        assert (1 - eps * np.cos(phi)) * (1 + eps * np.cos(gamma)) == pytest.approx(1 - eps**2)
        assert np.sign(gamma) == pytest.approx(np.sign(phi))

    @pytest.mark.parametrize("make", [journal_mesh, ring_mesh])
    @pytest.mark.parametrize(("eps", "ratio"), [(0.2, 2.0), (0.9, 0.3), (0.999, 1.0)])
    def test_weights_integrate_over_the_film(self, make, eps, ratio):
        """1, cos and 1/H around, against SciPy's quadrature; z⁴ over both halves."""
        errors = []
        for n in (64, 128):
            mesh = make(eps, ratio, n, n)
            low, high = mesh.phi[[0, -1]]
            exact = quad(lambda phi: np.cos(phi), low, high)[0], quad(gap, low, high, args=(eps,))[0]
            ours = mesh.weight_phi @ np.cos(mesh.phi), mesh.weight_phi @ gap(mesh.phi, eps)
            errors.append(max(abs(a - b) for a, b in zip(ours, exact, strict=True)))
            assert mesh.weight_phi.sum() == pytest.approx(high - low, rel=1e-3)
            assert mesh.weight_zeta @ mesh.zeta**4 == pytest.approx(2 / 5, rel=1e-3)
            assert (np.diff(mesh.phi) > 0).all()
            assert (np.diff(mesh.zeta) > 0).all()
        assert errors[1] < max(errors[0] / 8, 1e-9)  # fourth order, at least third

    def test_ends_of_the_meshes(self):
        ring, film = ring_mesh(0.6, 0.8, 32, 8), journal_mesh(0.6, 0.8, 32, 8)
        assert ring.phi[[0, -1]] == pytest.approx([-np.pi, np.pi])
        rupture = rupture_Swift_Stieber(0.6) - np.pi  # in Sommerfeld's angle
        assert film.phi[0] == pytest.approx(-np.pi)
        assert sommerfeld(film.phi[-1:], 0.6)[0] == pytest.approx(1.03 * rupture)
        assert film.zeta[[0, -1]] == pytest.approx([0, 1])
        assert film.coarser().phi == pytest.approx(film.phi[::2])
        assert film.coarser().zeta == pytest.approx(film.zeta[::2])

    @pytest.mark.parametrize("make", [journal_mesh, ring_mesh])
    @pytest.mark.parametrize(("eps", "ratio"), [(0.0, 1.0), (0.6, 0.02), (1 - 1e-7, 50.0)])
    def test_half_a_mesh_is_the_mesh_of_half_as_many_intervals(self, make, eps, ratio):
        half, made = halved(make(eps, ratio, 64, 16)), make(eps, ratio, 32, 8)
        for ours, theirs in zip(vars(half).values(), vars(made).values(), strict=True):
            assert ours == pytest.approx(theirs, rel=1e-12, abs=1e-14)

    @pytest.mark.parametrize("layer", [0.01, 0.5, 1.0, 3.0])
    def test_a_layer_at_the_end_is_resolved(self, layer):
        zeta, slope = graded_across(layer, 64)
        assert zeta[[0, -1]] == pytest.approx([0, 1], abs=1e-15)
        assert np.gradient(zeta)[1:-1] == pytest.approx(slope[1:-1], rel=2e-2)
        assert slope[-1] <= max(layer, 1 / 64)


class TestPadMeshes:
    @pytest.mark.parametrize("width", [0.05, 1.0, 20.0])
    @pytest.mark.parametrize("a", [1.0, 1.5, 100.0])
    def test_the_map_its_slope_and_its_inverse(self, a, width):
        graded, t = grading(np.array([a]), np.array([width])), np.linspace(0, 1, 201)
        x = graded.place(t)[0]
        assert x[[0, -1]] == pytest.approx([0, 1], abs=1e-12)
        assert (np.diff(x) > 0).all()
        inner, step = t[1:-1], 1e-6
        secant = (graded.place(inner + step) - graded.place(inner - step)) / (2 * step)
        assert graded.slope(inner) == pytest.approx(secant, rel=1e-4, abs=1e-6)
        assert graded.coordinate(x)[0] == pytest.approx(t, abs=1e-6)

    @pytest.mark.parametrize("width", [0.1, 1.0])
    def test_an_even_film_is_graded_alike_at_both_ends(self, width):
        graded, t = grading(np.array([1.0]), np.array([width])), np.linspace(0, 1, 11)
        assert graded.place(1 - t) == pytest.approx(1 - graded.place(t), abs=1e-6)

    def test_a_narrow_pad_has_finer_ends(self):
        t = np.array([0.0, 0.01, 0.5])
        first = [grading(np.array([1.2]), np.array([w])).place(t)[0, 1] for w in (0.05, 0.5, 5.0)]
        assert first == sorted(first)
        assert first[0] < 0.5 * 0.01

    @pytest.mark.parametrize(("a", "width"), [(1.0, 0.5), (4.0, 2.0)])
    def test_nodes_across_crowd_at_the_side(self, a, width):
        """In asinh of the distance over the layer, 1/(width sqrt a), they are equally spaced."""
        zeta = across(np.array([a]), np.array([width]), 40)[0]
        assert zeta[[0, -1]] == pytest.approx([0, 1], abs=1e-15)
        layer = 1 / (width * np.sqrt(a))
        share = (1 - zeta) / layer
        assert np.diff(np.arcsinh(share), 2) == pytest.approx(0, abs=1e-9)


class TestRegimes:
    def test_film_over_the_composite_roughness(self):
        h, R = np.array([1e-6, 2e-6, 1e-6]), np.array([3e-7, 0.0, 0.0])
        ratios = film_parameter(h, R, np.array([4e-7, 5e-7, 0.0]))
        assert ratios[:2] == pytest.approx([2, 4])
        assert np.isnan(ratios[2])

    def test_literature_limits_of_the_regimes(self):
        """Hamrock 2004, section 1.3: boundary below 1, mixed to 3."""
        words = lubrication_regime(np.array([0.999, 1.0, 3.0, 3.001, np.nan])).tolist()
        assert words == ["boundary", "mixed", "mixed", "full_film", ""]
        assert lubrication_regime(np.asarray(2.0)) == "mixed"

    def test_no_load_has_no_duty_and_no_coefficient(self):
        F = np.array([0.0, 0.5, 100.0])
        duty = duty_parameter(np.asarray(0.02), np.asarray(-100.0), np.asarray(0.05), np.asarray(0.04), F)
        assert np.isnan(duty[0])
        assert duty[1:] == pytest.approx([0.02 * 100 * 0.05 * 0.04 / 0.5, 0.02 * 100 * 0.05 * 0.04 / 100])
        friction = friction_coefficient(np.asarray(0.1), F, np.asarray(0.05))
        assert np.isnan(friction[0])
        assert friction[1:] == pytest.approx([0.1 / (0.5 * 0.025), 0.1 / (100 * 0.025)])


def test_corners_of_the_table_of_smallest_films():
    """DIN 31652-3, table 1: diameters above 24, 63, … up to 2500 mm, speeds up to 1, 3, 10, 30 and above."""
    d = np.array([24, 24.001, 63, 63.001, 2500, 2500.001]) * 1e-3
    slow, fast = (smallest_film_ISO_7902(d, np.asarray(U)) * 1e6 for U in (1.0, -31.0))
    assert np.isnan(slow[[0, 5]]).all()
    assert np.isnan(fast[[0, 5]]).all()
    assert slow[1:5] == pytest.approx([3, 3, 4, 10])
    assert fast[1:5] == pytest.approx([10, 10, 12, 18])
    assert np.isnan(smallest_film_ISO_7902(np.asarray(0.05), np.asarray(np.nan)))
