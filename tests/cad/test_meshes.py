"""STL and GLB are closed, without degenerate triangles, within the deflection, with named nodes."""

import json
import struct
from collections import Counter

import numpy as np
import pytest
from slow_models import DRAWN, quick_for

from cad.catalogue import models
from cad.errors import GeometryError
from cad.export import derive, is_derived
from cad.file_kinds import COARSEST, FINEST, STEPS, deflection_of, plain_kind, with_deflection
from cad.inspect import measure
from cad.mesh import closed_mesh, is_closed, mesh
from cad.step import read_step
from templates.core.errors import InvalidInputs

STL = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def stl(data):
    return np.frombuffer(data, STL, offset=84)["corners"]


def glb(data):
    """The JSON part of a GLB file, and the points (m, 3, 3) of the triangles of each mesh."""
    length = struct.unpack_from("<I", data, 12)[0]
    content, binary = json.loads(data[20 : 20 + length]), data[28 + length :]

    def read(number, dtype, width):
        accessor = content["accessors"][number]
        view = content["bufferViews"][accessor["bufferView"]]
        flat = np.frombuffer(binary, dtype, accessor["count"] * width, view["byteOffset"])
        return flat.reshape(-1, width)

    def corners(p):
        points = read(p["attributes"]["POSITION"], "<f4", 3)
        return points[read(p["indices"], "<u4", 1).ravel()].reshape(-1, 3, 3)

    triangles = [np.concatenate([*map(corners, one["primitives"])]) for one in content["meshes"]]
    return content, triangles


def edges(corners):
    """How often each directed edge of triangles (m, 3, 3) is there."""
    directed = (pair for a, b, c in corners.tolist() for pair in ((a, b), (b, c), (c, a)))
    return Counter((tuple(one), tuple(other)) for one, other in directed)


def gaps(corners):
    """Edges of one body that do not meet exactly one other turned round, by a second method."""
    counted = edges(corners)
    return [edge for edge, count in counted.items() if count != 1 or counted.get(edge[::-1]) != 1]


def unpaired(corners):
    """Edges of several bodies, which may touch, that are not there as often turned round."""
    counted = edges(corners)
    return [edge for edge, count in counted.items() if counted.get(edge[::-1]) != count]


def degenerate(corners):
    """Triangles with equal corners, or flatter than a hundred-thousandth of their length."""
    a, b, c = corners.astype(float).transpose(1, 0, 2)
    longest = np.max([np.linalg.norm(one - other, axis=1) for one, other in ((a, b), (b, c), (c, a))], axis=0)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) <= 1e-5 * longest**2


@quick_for(*DRAWN)
def test_files_are_closed_without_degenerate_triangles_and_nodes_have_the_names_of_parts(files, model):
    content, meshes = glb(files["glb"])
    whole = stl(files["stl"])
    assert len(whole) == sum(len(meshes[node["mesh"]]) for node in content["nodes"][1:])
    assert not unpaired(whole)
    assert not any(gaps(one) for one in meshes)
    assert not any(degenerate(one).any() for one in (whole, *meshes))
    parts = model.from_quantities(model.example).build()
    root, *nodes = content["nodes"]
    assert root["name"] == model.id
    assert [node["name"] for node in nodes] == [name for part in parts for name in part.names]
    assert [one["name"] for one in content["meshes"]] == [part.name for part in parts]


BALL = models().get("ball_bearing", 1)


@pytest.fixture(scope="module")
def bearing(example_of):
    return example_of(BALL)


@pytest.mark.parametrize("deflection", [5.0, 0.5, 0.05, 0.02])
def test_no_facet_of_a_ball_lies_farther_off_than_asked_for(bearing, deflection):
    ball = next(body for body in read_step(bearing.step) if body.name == "ball")
    one = closed_mesh(ball, deflection)
    radius = bearing.dimensions["ball_diameter"] / 2
    middles = np.linalg.norm(one.points[one.triangles].mean(axis=1), axis=1)
    assert np.abs(np.linalg.norm(one.points, axis=1) - radius).max() < 1e-6
    assert 0 < radius - middles.min() <= deflection


def test_a_finer_deflection_makes_more_triangles_and_a_truer_volume(bearing):
    kind, finer = with_deflection("stl", "9 mm"), with_deflection("stl", "200 um")
    few, many = stl(derive(bearing.step, kind)), stl(derive(bearing.step, finer))
    assert len(few) < len(many)
    assert not gaps(few)
    assert not degenerate(few).any()
    volumes = [
        np.einsum("ij,ij->i", c[:, 0], np.cross(c[:, 1], c[:, 2])).sum() / 6
        for c in map(np.float64, (few, many))
    ]
    wanted = bearing.measures["volume"]
    assert abs(volumes[1] - wanted) < abs(volumes[0] - wanted)


def test_equal_deflections_give_equal_bytes(bearing):
    assert with_deflection("glb", "0.0002 m") == with_deflection("glb", "200 um") == "glb@0.2mm"
    assert derive(bearing.step, "glb@0.2mm") == derive(bearing.step, "glb@0.2mm")
    assert derive(bearing.step, "glb@0.2mm") != derive(bearing.step, "glb")


@pytest.mark.parametrize(
    ("kind", "raw", "code"),
    [
        ("png", "1 mm", "not_offered"), ("step", "1 mm", "not_offered"), ("stl", "1", "missing_unit"),
        ("stl", "0 mm", "out_of_range"), ("stl", "-1 mm", "out_of_range"), ("stl", "1 kg", "wrong_unit"),
        ("stl", "1 ± 0.1 mm", "out_of_range"), ("stl", "nan mm", "not_a_quantity"),
        ("stl", "", "not_a_quantity"), ("stl", "1e999 mm", "not_finite"),
    ],
)  # fmt: skip
def test_what_is_no_deflection_is_refused_by_name(kind, raw, code):
    with pytest.raises(InvalidInputs) as refused:
        with_deflection(kind, raw)
    assert [(f.name, f.code) for f in refused.value.faults] == [("deflection", code)]


def least(length):
    """The finest step of deflections that is not finer than a length."""
    return min(float(f"{s}e{n}") for s in STEPS for n in range(-9, 6) if float(f"{s}e{n}") >= length)


@pytest.mark.parametrize(
    ("raw", "step"),
    [
        ("0.05 mm", "0.05"), ("0.0517 mm", "0.05"), ("0.0699 mm", "0.05"), ("0.07 mm", "0.07"),
        ("9.99 mm", "7"), ("10 mm", "10"), ("70 um", "0.07"), ("1 nm", "1e-06"),
        ("100 m", "100000"), ("0.1234567 in", "3"),
    ],
)  # fmt: skip
def test_a_deflection_has_the_step_that_is_not_coarser(raw, step):
    assert with_deflection("stl", raw) == f"stl@{step}mm"


def test_however_many_deflections_are_asked_for_a_solid_has_few_meshes(bearing):
    bodies = read_step(bearing.step)
    size = max(body.shape.BoundingBox().DiagonalLength for body in bodies)
    lengths = size * np.geomspace(FINEST, COARSEST, 400)
    kinds = {with_deflection("stl", f"{length:.9g} mm") for length in lengths}
    assert len(kinds) <= 20
    for length in lengths:
        asked, got = length, float(with_deflection("stl", f"{length:.9g} mm")[4:-2])
        assert 0.6 * asked <= got <= asked * (1 + 1e-8)
    fit = [kind for kind in kinds if float(kind[4:-2]) >= least(FINEST * size)]
    assert len(fit) <= 19
    assert all(deflection_of(kind, bodies) for kind in fit)


@pytest.mark.parametrize("raw", ["0.9 nm", "101 m", "1e300 mm", "1e-300 mm"])
def test_a_deflection_of_no_solid_is_refused_with_what_suits(raw):
    with pytest.raises(InvalidInputs, match="suits no solid; give 1e-06 to 100000 mm"):
        with_deflection("stl", raw)


@pytest.mark.parametrize("factor", [0.99 * FINEST, 1.01 * COARSEST, 1e-12, 1e6])
def test_a_deflection_that_does_not_suit_the_size_is_refused_with_the_sizes_that_do(bearing, factor):
    bodies = read_step(bearing.step)
    size = max(body.shape.BoundingBox().DiagonalLength for body in bodies)
    with pytest.raises(InvalidInputs, match=f"give {least(FINEST * size):g} to {COARSEST * size:.3g} mm"):
        deflection_of(f"stl@{factor * size:.6g}mm", bodies)
    assert deflection_of(f"stl@{2 * FINEST * size:.6g}mm", bodies) == pytest.approx(
        2 * FINEST * size, rel=1e-5
    )


def test_kinds_with_a_deflection_are_derived():
    assert is_derived("stl@0.1mm")
    assert is_derived("png")
    assert not is_derived("png@0.1mm")
    assert not is_derived("step")
    assert plain_kind("stl@0.1mm") == "stl"


def test_a_mesh_with_a_hole_is_not_closed(bearing):
    from dataclasses import replace

    ring = mesh(read_step(bearing.step)[0])
    assert is_closed(ring)
    assert not is_closed(replace(ring, triangles=ring.triangles[1:]))
    assert not is_closed(replace(ring, triangles=np.concatenate([ring.triangles, ring.triangles[:1]])))
    assert not is_closed(
        replace(ring, triangles=np.concatenate([ring.triangles[1:], ring.triangles[:1, ::-1]]))
    )


def test_a_gap_that_no_attempt_closes_is_an_error_by_name(bearing, monkeypatch):
    monkeypatch.setattr("cad.mesh.is_closed", lambda one: False)
    ball = read_step(bearing.step)[2]
    with pytest.raises(GeometryError, match="mesh of ball is not closed") as refused:
        closed_mesh(ball, 5.0)
    assert refused.value.code == "open_mesh"


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.09, 0.03, 3e-3, 1e-3, 3e-4])
def test_every_model_is_closed_at_every_deflection(example, share):
    bodies = read_step(example.step)
    size = max(body.shape.BoundingBox().DiagonalLength for body in bodies)
    for body in bodies:
        one = closed_mesh(body, share * size)
        corners = one.points[one.triangles].astype(np.float32)
        assert not gaps(corners)
        a, b, c = corners.astype(float).transpose(1, 0, 2)
        volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
        assert volume == pytest.approx(measure(body).volume, rel=max(0.1, 20 * share))
