"""Stress tensors of unit loads: beams, equilibrium, mirror images, a direct solution of loads together."""

from math import pi

import ngsolve as ng
import numpy as np
import pytest
from cadquery import Shape, Workplane

from cad.analysis.mesh import Fineness
from cad.analysis.unit_loads import LOADS, Crank, LoadedThrow, Ring, UnitStresses, fillet_stresses
from cad.errors import AnalysisError
from cad.header import Header
from cad.model import Part
from cad.models.crank_throw_v1 import CrankThrow
from cad.regenerate import regenerate
from cad.shaft import Shaft
from cad.step import write_step
from templates.physics.fatigue.tensors import superposed

COARSE = Fineness(size=0.9, curvature=0.5, turn=pi / 3)
SIZES = {"journal_diameter": 0.055, "journal_length": 0.04, "pin_diameter": 0.048, "pin_length": 0.032,
         "web_thickness": 0.018, "web_width": 0.08, "throw": 0.042, "fillet": 0.003}  # fmt: skip
CRANK = Crank(42.0, 24.0, 32.0, 27.5, 18.0, 3.0)


@pytest.fixture(scope="module")
def bar() -> LoadedThrow:
    """A round bar, mid-length at z = 0: with a throw of 0 its pin is the bar itself."""
    radius, length = 20.0, 200.0
    shape = Workplane().workplane(offset=-length / 2).circle(radius).extrude(length).val()
    assert isinstance(shape, Shape)
    step = write_step((Part("bar", shape, 1.0),), Header("bar", 1, {}, "0" * 64))
    crank = Crank(0.0, radius, 40.0, radius, 10.0, 0.0)
    return LoadedThrow(step, Shaft(-length / 2, length / 2), crank, Fineness(0.4, 1.5, pi / 6), 3)


@pytest.fixture(scope="module")
def throw() -> LoadedThrow:
    step = regenerate("crank_throw", 1, SIZES).step
    return LoadedThrow(step, CrankThrow.from_si(SIZES).shaft(), CRANK, COARSE, 2)


@pytest.fixture(scope="module")
def found(throw: LoadedThrow) -> UnitStresses:
    return fillet_stresses(throw)


@pytest.mark.slow
class TestBar:
    """A round bar between two levels of z where no load comes in: beams to 1 % of the largest stress."""

    @pytest.mark.parametrize("load", LOADS)
    def test_analytic_beam(self, bar: LoadedThrow, load: str) -> None:
        points, tensors = bar.on_surface(bar.response({load: 1.0}))
        x, y, z = points[(low := (points[:, 2] > -60) & (points[:, 2] < -40))].T
        second = pi / 4 * 20.0**4
        expected = np.zeros((len(x), 6))
        about = {"force_1": (0.0, -0.5 * (z + 100)), "force_2": (0.5 * (z + 100), 0.0),
                 "moment_2": (1.0, 0.0), "moment_3": (0.0, 1.0)}  # fmt: skip
        moment = about.get(load)
        if moment:
            expected[:, 2] = (moment[0] * y - moment[1] * x) / second
        if load == "moment_1":
            expected[:, 5], expected[:, 4] = -y / (2 * second), x / (2 * second)
        largest = np.abs(expected).max()
        shear = (
            1.0 / (pi * 20.0**2) if load.startswith("force") else 0.0
        )  # 3/4 of it at most, of half the force
        assert np.abs(tensors[low] - expected).max() < 0.01 * largest + shear


@pytest.mark.slow
class TestThrow:
    def test_conservation_resultants(self, throw: LoadedThrow) -> None:
        """Work of the forces in rigid motions, as far as the mesh is symmetric: only the torque is left."""
        space = throw.system.space
        arm = -throw.shaft.held
        motions = {"x": ng.CF((1, 0, 0)), "y": ng.CF((0, 1, 0)), "z": ng.CF((0, 0, 1)),
                   "about x": ng.CF((0, -(ng.z + arm), ng.y)), "about y": ng.CF((ng.z + arm, 0, -ng.x)),
                   "about z": ng.CF((-ng.y, ng.x, 0))}  # fmt: skip
        expected = {
            "force_1": {"x": 0.5}, "force_2": {"y": 0.5, "about z": 42.0}, "moment_1": {"about z": 1.0},
            "moment_2": {"about x": 1.0}, "moment_3": {"about y": 1.0},
        }  # fmt: skip
        for load in LOADS:
            force = throw.force({load: 1.0})
            for name, motion in motions.items():
                rigid = ng.GridFunction(space)
                rigid.Set(motion)
                work = float(ng.InnerProduct(force, rigid.vec))
                assert work == pytest.approx(expected[load].get(name, 0.0), abs=1e-4 * 54), (load, name)

    def test_property_both_webs_are_alike(self, found: UnitStresses) -> None:
        """Of a force on mid-pin of a symmetric throw; the held end disturbs its journal a little."""
        values = found.tensors["force_1"]
        sizes = [np.abs(values[found.points[:, 2] * side > 0]).max() for side in (-1, 1)]
        assert sizes[0] == pytest.approx(sizes[1], rel=0.06)

    def test_property_every_fillet_is_looked_at_all_round(self, found: UnitStresses) -> None:
        rings = CRANK.rings()
        assert len(found.points) == len(rings) * 24
        assert [int(ring.holds(found.points).sum()) for ring in rings] == [24] * 4

    def test_conservation_superposed_is_the_direct_solution(
        self, throw: LoadedThrow, found: UnitStresses
    ) -> None:
        """At three angles of a history of all five loads: another solution, of the loads together."""
        angles = np.array([10.0, 95.0, 250.0])
        history = {
            "force_1": 46e3 * np.cos(np.radians(angles)), "force_2": 20e3 * np.sin(np.radians(2 * angles)),
            "moment_1": 5e5 * np.sin(np.radians(angles)), "moment_2": np.array([2e5, -1e5, 3e4]),
            "moment_3": np.array([-1e5, 4e5, 2e5]),
        }  # fmt: skip
        rows = [tuple(map(tuple, found.tensors[load].tolist())) for load in LOADS]
        added = superposed([history[load] for load in LOADS], rows)
        for number in range(len(angles)):
            together = throw.response({load: float(values[number]) for load, values in history.items()})
            points, direct = throw.on_surface(together)
            places = [int(np.argmin(np.abs(points - point).sum(axis=1))) for point in found.points]
            assert np.abs(direct[places]).max() > 50
            assert np.abs(added[:, number] - direct[places]).max() < 1e-6 * np.abs(direct[places]).max()

    def test_property_a_sharp_corner_is_refused(self, throw: LoadedThrow) -> None:
        sharp = Ring(500.0, 1.0, 2.0, 0.0, 1.0)
        assert not sharp.holds(np.zeros((3, 3))).any()
        with pytest.raises(AnalysisError, match="no plain cylinder"):
            _with_another_pin(throw).force({"force_1": 1.0})


def _with_another_pin(throw: LoadedThrow) -> LoadedThrow:
    """The same solid, its pin said to be thicker than it is."""
    other = LoadedThrow.__new__(LoadedThrow)
    other.__dict__.update(throw.__dict__, crank=Crank(42.0, 30.0, 32.0, 27.5, 18.0, 3.0))
    return other
