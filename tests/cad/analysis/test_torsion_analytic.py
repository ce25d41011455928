"""Analytic: shafts of known stiffness and frequency; halves that must equal their wholes."""

from math import pi, sqrt
from typing import Any

import netgen.meshing
import ngsolve as ng
import numpy as np
import pytest
from cadquery import Shape, Workplane
from netgen.occ import OCCGeometry

from cad.analysis.corners import sharp_inner_edges
from cad.analysis.elastic import System, respond
from cad.analysis.kinds import BOUNDARIES, DEFAULT_LEVEL, Boundary
from cad.analysis.levels import LEVELS, Level
from cad.analysis.mesh import Grid, make_grid
from cad.analysis.modes import natural_modes, torsional_mode
from cad.analysis.solid import LOADED, MIRROR, Solid, read_solid
from cad.header import Header
from cad.model import Part
from cad.shaft import STEEL_MATERIAL, Shaft
from cad.step import write_step
from tests.references.shoulder_fillet import END, FILLET, NARROW, SHOULDER, shoulder

SHEAR = STEEL_MATERIAL.young / 2 / (1 + STEEL_MATERIAL.poisson)
FINE = LEVELS[-1]


def shaft_of(workplane: Workplane, length: float, mirrors: tuple[str, ...] = ("y", "x")) -> Solid:
    shape = workplane.val()
    assert isinstance(shape, Shape)
    step = write_step((Part("shaft", shape, 1.0),), Header("shaft", 1, {}, "0" * 64))
    return read_solid(step, Shaft(0.0, length), mirrors)


@pytest.mark.parametrize(
    "level",
    [
        pytest.param(level, marks=pytest.mark.slow if level.name == "fine" else ())
        for level in LEVELS
        if level.name in (DEFAULT_LEVEL, "fine")
    ],
)
def test_a_circular_shaft_twists_and_vibrates_as_coulomb_says(level: Level) -> None:
    """K = G I_p / l and f = sqrt(G / rho) / (4 l), exact for a circular section, held and free."""
    solid = shaft_of(Workplane().circle(25).extrude(200), 200)
    system = System(make_grid(solid, level.fineness), level.order, STEEL_MATERIAL, "torsion")
    response = respond(system, "free_end")
    stiffness = SHEAR * pi / 32 * 0.05**4 / 0.2
    assert 1e-3 / response.compliance == pytest.approx(stiffness, rel=5e-4)
    frequency = sqrt(SHEAR / STEEL_MATERIAL.density) / 0.8
    assert torsional_mode(response).frequency == pytest.approx(frequency, rel=5e-4)


def test_a_moment_bends_as_its_sign_says() -> None:
    """A positive moment about y turns z towards x: the free end moves to +x, by M l² / (2 E I)."""
    solid = shaft_of(Workplane().circle(10).extrude(100), 100)
    response = respond(System(make_grid(solid, FINE.fineness), 3, STEEL_MATERIAL, "bending"), "free_end")
    mesh = response.system.grid.mesh
    area = ng.Integrate(ng.CF(1) * ng.ds(LOADED), mesh)
    moved = ng.Integrate(response.displacement[0] * ng.ds(LOADED), mesh) / area
    assert moved == pytest.approx(100**2 / (2 * STEEL_MATERIAL.young * 1e-6 * pi / 4 * 10**4), rel=0.01)


@pytest.mark.parametrize(
    ("order", "boundary"),
    [
        (3, "guided_end"),
        pytest.param(3, "free_end", marks=pytest.mark.slow),
        pytest.param(4, "guided_end", marks=pytest.mark.slow),
    ],
)
def test_few_forces_are_answered_as_by_the_factorised_matrix(order: int, boundary: Boundary) -> None:
    """By conjugate gradients over second order: to their residual, which counts twice in a compliance."""
    grid = make_grid(shaft_of(Workplane().rect(40, 30).extrude(60), 60), LEVELS[0].fineness)
    systems = [System(grid, order, STEEL_MATERIAL, "bending", few_forces=few) for few in (True, False)]
    iterated, factorised = (respond(system, boundary).compliance for system in systems)
    assert iterated == pytest.approx(factorised, rel=1e-8)
    assert 1 < systems[0].inverse.iterations < 100


@pytest.mark.slow  # the threads wait in loops
def test_a_mesh_made_on_one_thread_is_that_of_several() -> None:
    solid, level = shaft_of(Workplane().circle(25).extrude(60), 60), LEVELS[0]
    one = make_grid(solid, level.fineness).mesh.ngmesh
    sizes = netgen.meshing.MeshingParameters(
        maxh=level.fineness.size * solid.scale, grading=0.5, curvaturesafety=level.fineness.curvature
    )
    several = OCCGeometry(solid.shape).GenerateMesh(sizes)
    assert [[*point] for point in one.Points()] == [[*point] for point in several.Points()]
    assert [element.vertices for element in one.Elements3D()] == [
        element.vertices for element in several.Elements3D()
    ]


def test_sharp_inner_edges_are_found_and_no_others() -> None:
    plain, stepped = (read_solid(shoulder(fillet), Shaft(0.0, END)) for fillet in (FILLET, 0.0))
    assert len(sharp_inner_edges(plain.shape, plain.scale).ends) == 0
    result = sharp_inner_edges(stepped.shape, 1.5 * NARROW)
    assert np.hypot(result.ends[..., 0], result.ends[..., 1]) == pytest.approx(NARROW / 2, rel=1e-6)
    assert result.ends[..., 2] == pytest.approx(SHOULDER)
    assert result.radius == pytest.approx(NARROW / 2, rel=0.1)  # by polygons: its ends lie on the edge


@pytest.mark.slow
def test_a_square_bar_has_saint_venants_torsion_constant() -> None:
    """0.140577 a⁴ (de Saint-Venant 1855), from two lengths: what the ends do cancels in the difference."""
    compliance = []
    for length in (100.0, 160.0):
        solid = shaft_of(Workplane().rect(40, 40).extrude(length), length)
        system = System(make_grid(solid, FINE.fineness), FINE.order, STEEL_MATERIAL, "torsion")
        compliance.append(respond(system, "free_end").compliance * 1e3)
    constant = 0.06 / (compliance[1] - compliance[0]) / SHEAR
    assert constant == pytest.approx(0.140577 * 0.04**4, rel=2e-3)


def test_half_of_a_shaft_is_exactly_half_of_the_mirrored_mesh() -> None:
    """Antisymmetry loses nothing: a mesh and its image, joined, tell the same to rounding."""
    solid = shaft_of(Workplane().rect(40, 30).extrude(60), 60, ("y",))
    grid = make_grid(solid, LEVELS[0].fineness)
    half = respond(System(grid, 3, STEEL_MATERIAL, "torsion"), "free_end").compliance
    whole = Solid(solid.shape, "", solid.radius)
    joined = Grid(mirrored(grid.mesh), whole)
    full = respond(System(joined, 3, STEEL_MATERIAL, "torsion"), "free_end").compliance
    assert half == pytest.approx(full, rel=1e-6)


@pytest.mark.slow  # the test before asks the same of one mesh, exactly
@pytest.mark.parametrize(
    "boundary",
    [pytest.param(one, marks=pytest.mark.slow if one == "free_end" else ()) for one in BOUNDARIES],
)
def test_half_and_whole_agree_within_what_is_reported(boundary: Boundary) -> None:
    block = write_step((Part("shaft", flat(), 1.0),), Header("shaft", 1, {}, "0" * 64))
    reported = []
    for mirrors in (("y",), ()):
        solid = read_solid(block, Shaft(0.0, 60.0), mirrors)
        grid = make_grid(solid, LEVELS[1].fineness)
        low, high = (
            respond(System(grid, order, STEEL_MATERIAL, "torsion"), boundary).compliance for order in (2, 3)
        )
        reported.append((high, LEVELS[1].error(low, high)))
    (half, error), (full, other) = reported
    assert abs(half / full - 1) <= error + other


def test_a_solid_that_does_not_mirror_itself_is_not_halved() -> None:
    block = Workplane().rect(40, 40).extrude(60)
    lopsided = block.cut(Workplane().center(15, 12).circle(3).extrude(60))
    assert shaft_of(block, 60).mirror == "y"
    assert shaft_of(lopsided, 60).mirror == ""


def test_a_small_hole_is_enough_to_keep_a_solid_whole() -> None:
    """It takes 0.2 per mille of the volume away, and moves no face: neither is within the kernel's noise."""
    block = Workplane().rect(40, 40).extrude(60)
    pierced = block.cut(Workplane().center(15, 12).circle(0.3).extrude(60))
    assert shaft_of(pierced, 60).mirror == ""


@pytest.mark.parametrize(("place", "radius"), [(-12.05, 3.0), (-12.0, 3.02)])
def test_halves_that_differ_by_a_hair_are_no_images(place: float, radius: float) -> None:
    """As many faces, areas and centres alike within a per cent: two holes that are not quite a pair."""
    block = Workplane().rect(40, 40).extrude(60)
    upper = Workplane().center(15, 12).circle(3.0).extrude(60)
    pair, odd = (Workplane().center(15, y).circle(r).extrude(60) for y, r in ((-12.0, 3.0), (place, radius)))
    assert shaft_of(block.cut(upper).cut(pair), 60).mirror == "y"
    assert shaft_of(block.cut(upper).cut(odd), 60).mirror == ""


def test_a_guide_raises_the_frequency_of_a_shaft_beside_its_axis() -> None:
    """Rayleigh: a constraint lowers no frequency. Off its axis a bar twists about itself unless guided."""
    solid = shaft_of(Workplane().center(15, 0).rect(20, 20).extrude(100), 100)
    system = System(make_grid(solid, LEVELS[0].fineness), 2, STEEL_MATERIAL, "torsion")
    free, guided = (natural_modes(respond(system, boundary), 6) for boundary in BOUNDARIES)
    for one, other in zip(free, guided, strict=True):
        assert other.frequency > one.frequency * 0.999
    assert guided[0].frequency > 1.5 * free[0].frequency


def flat() -> Shape:
    shape = Workplane().rect(40, 30).extrude(60).val()
    assert isinstance(shape, Shape)
    return shape


def mirrored(mesh: Any) -> ng.Mesh:
    """A mesh of flat faces, joined with its image in y = 0."""
    old, new = mesh.ngmesh, netgen.meshing.Mesh()
    names = list(mesh.GetBoundaries())
    for index, name in enumerate(names, 1):
        new.Add(netgen.meshing.FaceDescriptor(surfnr=index, domin=1, bc=index))
        new.SetBCName(index - 1, name)
    places = [tuple(point) for point in old.Points()]
    same = [new.Add(netgen.meshing.MeshPoint(netgen.meshing.Pnt(x, y, z))) for x, y, z in places]
    image = [
        point if abs(y) < 1e-9 else new.Add(netgen.meshing.MeshPoint(netgen.meshing.Pnt(x, -y, z)))
        for point, (x, y, z) in zip(same, places, strict=True)
    ]
    for element in old.Elements3D():
        a, b, c, d = (vertex.nr - 1 for vertex in element.vertices)
        new.Add(netgen.meshing.Element3D(1, [same[a], same[b], same[c], same[d]]))
        new.Add(netgen.meshing.Element3D(1, [image[a], image[c], image[b], image[d]]))
    for face in old.Elements2D():
        if names[face.index - 1] != MIRROR:
            a, b, c = (vertex.nr - 1 for vertex in face.vertices)
            new.Add(netgen.meshing.Element2D(face.index, [same[a], same[b], same[c]]))
            new.Add(netgen.meshing.Element2D(face.index, [image[a], image[c], image[b]]))
    return ng.Mesh(new)
