"""The beams of an elastic crank, and reactions by the force method, agree with closed forms."""

import numpy as np
import pytest

from templates.physics.crankshaft.crank_frame import CrankFrame, CrankSections, Frame, Throw
from templates.physics.crankshaft.crank_supports import Flexibility, self_balancing, support_reactions
from templates.physics.crankshaft.main_bearings import lever_shares
from templates.physics.crankshaft.shaft_loads import reactions_of

E, NU = 210e9, 0.3
G = E / (2 * (1 + NU))
STEEL = CrankSections(0.055, 0.048, 0.032, 0.018, 0.08, E, NU, 8.0)
MAINS = np.arange(5) * 0.094
CYLINDERS = MAINS[:-1] + 0.047


def cantilever(direction, length=0.4, d=0.05):
    """Displacements of the end of a round bar to six unit loads there, the other end fixed, (6, 6)."""
    frame = Frame(STEEL)
    ends = [frame.node(0j, 0.0), frame.node(complex(*direction[:2]) * length, direction[2] * length)]
    frame.bar(*ends, d)
    return np.linalg.inv(frame.stiffness()[6:, 6:])


@pytest.mark.parametrize(("direction", "along"), [((0, 0, 1), 2), ((1, 0, 0), 0), ((0, 1, 0), 1)])
def test_analytic_cantilever_bends_stretches_and_twists(direction, along):
    """L³/(3EI) + L/(G A_s), L/(EA), L/(GJ), and L²/(2EI) between force and turn."""
    length, d = 0.4, 0.05
    A, I = np.pi * d**2 / 4, np.pi * d**4 / 64  # noqa: E741
    C = cantilever(direction)
    for axis in range(3):
        if axis == along:
            expected = length / (E * A), length / (G * 2 * I)
        else:
            expected = length**3 / (3 * E * I) + length / (G * 0.886 * A), length / (E * I)
        assert C[axis, axis] == pytest.approx(expected[0], rel=1e-9)
        assert C[3 + axis, 3 + axis] == pytest.approx(expected[1], rel=1e-9)
    across = np.abs(C[:3, 3:])
    assert across.max() == pytest.approx(length**2 / (2 * E * I), rel=1e-9)
    assert pytest.approx(C, rel=1e-9, abs=1e-18) == C.T


def test_analytic_web_is_stiffer_across_its_width():
    frame = Frame(STEEL)
    frame.web(frame.node(0j, 0.0), frame.node(0.042 + 0j, 0.0))
    C = np.linalg.inv(frame.stiffness()[6:, 6:])
    t, b, L = 0.018, 0.08, 0.042
    shear = L / (G * 5 / 6 * t * b)
    assert C[2, 2] == pytest.approx(L**3 / (3 * E * b * t**3 / 12) + shear, rel=1e-9)  # along the shaft
    assert C[1, 1] == pytest.approx(L**3 / (3 * E * t * b**3 / 12) + shear, rel=1e-9)


def test_analytic_straight_bar_on_three_supports():
    """One load in the middle of the first of two spans: 13, 22 and −3 of 32, by the three-moment equation."""
    z = np.array([0.0, 1.0, 2.0])
    load = np.array([0.5])

    def sag(x, a, L=2.0):
        """Deflection times 6 E I of a bar held at 0 and L, at x, to a unit load at a."""
        x, a = np.minimum(x, a), np.maximum(x, a)
        b = L - a
        return b * x * (L**2 - b**2 - x**2) / L

    plane = np.eye(2)
    shaft = Flexibility(np.kron(sag(z[:, None], z), plane), np.kron(sag(z[:, None], load), plane))
    reactions = support_reactions(z, load, shaft, np.full(3, np.inf))
    assert -32 * reactions[::2, 0] == pytest.approx([13, 22, -3], abs=1e-12)
    assert -32 * reactions[1::2, 1] == pytest.approx([13, 22, -3], abs=1e-12)
    assert reactions[::2, 1] == pytest.approx(0, abs=1e-15)


def test_conservation_levers_and_self_balancing_sets():
    places = np.array([-0.02, 0.03, 0.2, 0.4])
    shares = lever_shares(MAINS, places)
    assert shares.sum(axis=0) == pytest.approx(1, rel=1e-14)
    assert MAINS @ shares == pytest.approx(places, abs=1e-15)
    basis = self_balancing(MAINS)
    assert basis.sum(axis=0) == pytest.approx(0, abs=1e-15)
    assert MAINS @ basis == pytest.approx(0, abs=1e-15)


@pytest.mark.parametrize("stiffness", [1e3, 2e8, 1e12, np.inf])
def test_conservation_reactions_balance_every_unit_load(stiffness):
    psi = np.radians([0, 90, 270, 180])
    webs = np.array([0.022, 0.354])
    reactions = reactions_of(
        MAINS, CYLINDERS, webs, np.arange(4), psi, np.full(4, 0.043), STEEL, np.array(stiffness)
    )
    places = np.concatenate([CYLINDERS, webs])
    assert reactions.shape == (10, 12)
    force = reactions.reshape(5, 2, 12).sum(axis=0)
    moment = np.einsum("n,ndl->dl", MAINS, reactions.reshape(5, 2, 12))
    assert force == pytest.approx(-np.tile(np.eye(2), 6), abs=1e-12)
    assert moment == pytest.approx(-np.kron(places, np.eye(2)), abs=1e-12)


def test_analytic_flexibility_is_that_of_the_law_of_the_supports():
    """The second method: the whole stiffness with springs, S u + k u = F, reactions −k u."""
    psi, k = np.radians([0, 180, 180, 0]), 2e8
    throws = [
        Throw(z, ((z, 0.043 * np.exp(1j * a), j),))
        for j, (z, a) in enumerate(zip(CYLINDERS, psi, strict=True))
    ]
    whole = CrankFrame(STEEL, MAINS, throws)
    K = whole.frame.stiffness()
    at_mains = np.array([6 * node + d for node in whole.at_main for d in (0, 1)])
    K[at_mains, at_mains] += k
    free = np.setdiff1d(np.arange(len(K)), [6 * whole.axis[-1][1] + 2, 6 * whole.axis[-1][1] + 5])
    F = np.zeros((len(K), 8))
    for j in range(4):
        for d in (0, 1):
            F[6 * whole.at_load[j] + d, 2 * j + d] = 1
    u = np.zeros_like(F)
    u[free] = np.linalg.solve(K[np.ix_(free, free)], F[free])
    found = reactions_of(
        MAINS, CYLINDERS, np.zeros(0), np.arange(4), psi, np.full(4, 0.043), STEEL, np.array(k)
    )
    assert found == pytest.approx(-k * u[at_mains], abs=1e-7)


def test_limit_a_load_beside_a_main_goes_to_it_on_rigid_supports():
    webs = MAINS[[2]] + 1e-9
    reactions = reactions_of(
        MAINS, CYLINDERS, webs, np.arange(4), np.zeros(4), np.full(4, 0.043), STEEL, np.array(np.inf)
    )
    assert reactions[4, 8] == pytest.approx(-1, abs=1e-6)


def test_property_split_pins_share_a_throw():
    """A split of almost nothing is that of a shared pin."""
    places, throw = np.array([0.040, 0.054]), np.array([0, 0])
    mains = np.array([0.0, 0.047 + 0.047, 0.188])
    common = (mains, places, np.zeros(0), throw)
    tail = (np.full(2, 0.043), STEEL, np.array(2e8))
    shared = reactions_of(*common, np.radians([10, 10]), *tail)
    split = reactions_of(*common, np.radians([10, 10.5]), *tail)
    assert np.abs(split - shared).max() < 0.02
    wide = reactions_of(*common, np.radians([10, 40]), *tail)
    assert np.isfinite(wide).all()
