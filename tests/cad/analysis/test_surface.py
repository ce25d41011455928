"""Analytic: the surface data of a circular shaft follow Coulomb.

A half with its mirror image is the whole.
"""

from math import degrees, pi, sqrt

import numpy as np
import pytest
from cadquery import Shape, Workplane
from test_torsion_analytic import mirrored

from cad.analysis.analyse import AnalysisRequest, analyse
from cad.analysis.elastic import System, respond
from cad.analysis.kinds import Kind
from cad.analysis.mesh import Fineness, Grid, make_grid
from cad.analysis.solid import Solid, read_solid
from cad.analysis.surface import LOADS, MOST_TRIANGLES, Surface, surface
from cad.header import Header
from cad.model import Part
from cad.shaft import STEEL_MATERIAL, Shaft
from cad.step import write_step

DIAMETER, LENGTH = 40.0, 120.0  # mm
SHEAR = STEEL_MATERIAL.young / 2 / (1 + STEEL_MATERIAL.poisson)
POLAR = pi / 32 * (DIAMETER / 1e3) ** 4  # m⁴
FINE, COARSE = Fineness(0.35, 0.9, pi / 6), Fineness(0.35, 1.0, pi / 2)


def step_of(workplane: Workplane) -> bytes:
    shape = workplane.val()
    assert isinstance(shape, Shape)
    return write_step((Part("shaft", shape, 1.0),), Header("shaft", 1, {}, "0" * 64))


ROUND = step_of(Workplane().circle(DIAMETER / 2).extrude(LENGTH))


def seen(step: bytes, length: float, load: Kind, mirrors: tuple[str, ...]) -> Surface:
    solid = read_solid(step, Shaft(0.0, length), mirrors)
    assert solid.mirror == "".join(mirrors)
    return surface_of(make_grid(solid, FINE), load)


def surface_of(grid: Grid, load: Kind) -> Surface:
    return surface(respond(System(grid, 3, STEEL_MATERIAL, load), "free_end"))


def volume(result: Surface) -> float:
    """The volume inside the triangles [mm³], by the theorem of Gauss; positive if they turn outward."""
    a, b, c = (result.points[result.triangles[:, corner]] for corner in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def edges(result: Surface) -> set[int]:
    """How often an edge of the surface is that of a triangle."""
    sides = np.concatenate([result.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    return {int(n) for n in np.unique(np.sort(sides, axis=1), axis=0, return_counts=True)[1]}


@pytest.fixture(scope="module")
def coulomb() -> Surface:
    return seen(ROUND, LENGTH, "torsion", ("y",))


@pytest.mark.slow
def test_the_twist_is_linear_along_a_circular_shaft(coulomb: Surface) -> None:
    """φ = T z / (G J) at every point, on the rim, on the end faces, on the axis."""
    assert coulomb.twist is not None
    wanted = np.degrees(coulomb.points[:, 2] / 1e3 / (SHEAR * POLAR))
    largest = degrees(LENGTH / 1e3 / (SHEAR * POLAR))
    assert np.abs(coulomb.twist - wanted).max() < 0.01 * largest


def test_every_point_moves_round_the_axis(coulomb: Surface) -> None:
    x, y, z = coulomb.points.T
    angle = z / (SHEAR * POLAR) * 1e-3
    wanted = np.column_stack([-angle * y, angle * x, 0 * z])
    assert np.abs(coulomb.displacement - wanted).max() < 0.01 * np.abs(wanted).max()


def test_the_stress_grows_from_the_axis_to_the_rim(coulomb: Surface) -> None:
    """τ = T r / J, at the rim 16 T / (π d³); von Mises √3 of it."""
    radius = np.hypot(coulomb.points[:, 0], coulomb.points[:, 1])
    rim = sqrt(3) * 16 / (pi * (DIAMETER / 1e3) ** 3) / 1e6
    wanted = rim * radius / (DIAMETER / 2)
    on_rim = radius > 0.999 * DIAMETER / 2
    assert coulomb.stress[on_rim] == pytest.approx(wanted[on_rim], rel=0.01)
    assert np.abs(coulomb.stress - wanted).max() < 0.02 * rim  # in the middle of an end too


def test_the_surface_is_round_and_closed(coulomb: Surface) -> None:
    assert edges(coulomb) == {2}
    assert volume(coulomb) == pytest.approx(pi / 4 * DIAMETER**2 * LENGTH, rel=0.01)
    side = (coulomb.points[:, 2] > 1) & (coulomb.points[:, 2] < LENGTH - 1)
    assert np.hypot(*coulomb.points[side, :2].T) == pytest.approx(DIAMETER / 2, rel=1e-3)
    assert 1000 < len(coulomb.triangles) <= MOST_TRIANGLES


IMAGES = [(load, mirrors) for load in LOADS for mirrors in (("y",), ("x",))]


@pytest.mark.slow  # the next test asks the same of one load, on the same mesh
@pytest.mark.parametrize(("load", "mirrors"), IMAGES)
def test_an_image_moves_as_the_other_half_does(load: Kind, mirrors: tuple[str, ...]) -> None:
    """In sign and size: another mesh, of the whole, gives the same up to what two meshes differ by."""
    block = step_of(Workplane().rect(40, 30).extrude(60))
    half, whole = seen(block, 60.0, load, mirrors), seen(block, 60.0, load, ())
    for result in (half, whole):
        assert edges(result) == {2}
        assert volume(result) == pytest.approx(72e3, rel=1e-9)
    apart = np.linalg.norm(half.points[:, None] - whole.points[None], axis=2)
    same, other = np.nonzero(apart < 1e-9)  # on the edges of the block
    assert len(same) > 8
    assert {tuple(sign) for sign in np.sign(half.points[same][:, :2])} >= {(1, 1), (1, -1), (-1, 1), (-1, -1)}
    largest = np.abs(whole.displacement).max()
    assert np.abs(half.displacement[same] - whole.displacement[other]).max() < 0.005 * largest
    if half.twist is not None and whole.twist is not None:
        assert (
            np.abs(half.twist[same] - whole.twist[other]).max() < 0.05 * np.abs(whole.twist).max()
        )  # a slope


@pytest.mark.slow
def test_a_half_with_its_image_is_the_mirrored_mesh() -> None:
    """The same elements on both sides: displacements to rounding; what is recovered, off the plane."""
    solid = read_solid(step_of(Workplane().rect(40, 30).extrude(30)), Shaft(0.0, 30.0), ("y",))
    grid = make_grid(solid, COARSE)
    half = surface_of(grid, "torsion")
    whole = surface_of(Grid(mirrored(grid.mesh), Solid(solid.shape, "", solid.radius)), "torsion")
    assert len(half.points) == len(whole.points)
    near = np.linalg.norm(half.points[:, None] - whole.points[None], axis=2).argmin(axis=0)
    assert half.points[near] == pytest.approx(whole.points, abs=1e-9)
    assert np.abs(half.displacement[near] - whole.displacement).max() < 1e-6 * np.abs(half.displacement).max()
    off = np.abs(whole.stress - half.stress[near])
    assert np.sqrt((off**2).mean()) < 0.02 * whole.stress.max()
    assert off[np.abs(whole.points[:, 1]) == 15].max() < 1e-6 * whole.stress.max()


@pytest.mark.slow
def test_it_is_calculated_only_by_name_and_has_units() -> None:
    """Of a level alone; by a tolerance at the level at which the stiffness meets it."""
    shaft, seen_at = Shaft(0.0, LENGTH), []
    for asked in (
        AnalysisRequest(level="coarse"),
        AnalysisRequest("bending", level="coarse"),
        AnalysisRequest(tolerance=0.05),
    ):
        result = analyse(ROUND, shaft, asked, ["surface"], lambda done, what: None).outputs
        assert result.keys() == {"surface"}
        reported = result["surface"]["value"].as_json()
        units = {name: part["unit"] for name, part in reported.items() if name not in ("load", "triangles")}
        twist = {"twist": "deg"} if asked.load == "torsion" else {}
        assert units == {"points": "mm", "displacement": "mm", **twist, "stress": "MPa"}
        assert {len(reported[name]["value"]) for name in units} == {len(reported["points"]["value"])}
        assert max(max(corners) for corners in reported["triangles"]) == len(reported["points"]["value"]) - 1
        assert result["surface"]["mesh"]["degrees_of_freedom"] > 0
        seen_at.append(reported["load"])
    assert seen_at == ["a torque of 1 N*m about z", "a moment of 1 N*m about y", "a torque of 1 N*m about z"]
    both = analyse(
        ROUND, shaft, AnalysisRequest(level="coarse"), ["stiffness", "surface"], lambda done, what: None
    )
    assert both.outputs["stiffness"]["mesh"] == both.outputs["surface"]["mesh"]
