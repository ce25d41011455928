"""3MF, BREP and files of one part: closed, with the right volumes, positions and names."""

import io
import re
import struct
from zipfile import ZipFile

import cadquery
import numpy as np
import pytest
from defusedxml import ElementTree
from slow_models import DRAWN, quick_for

from cad.errors import GeometryError
from cad.export import derive
from cad.file_kinds import BY_PART, plain_kind, with_deflection, with_part
from cad.header import ONLY_PART, read_header
from cad.inspect import bounding_box, measure
from cad.mesh import closed_mesh
from cad.model import STEEL
from cad.regenerate import as_text, regenerate_class
from cad.stamp import Stamp, is_copy, stamped
from cad.statements import read_statements
from cad.step import Body, read_step
from templates.core.errors import InvalidInputs

STL = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"


def model_of(package):
    """The XML of the model in a 3MF package."""
    with ZipFile(io.BytesIO(package)) as archive:
        assert archive.testzip() is None
        assert archive.namelist() == ["[Content_Types].xml", "_rels/.rels", "3D/3dmodel.model"]
        return ElementTree.fromstring(archive.read("3D/3dmodel.model"))


def mesh_of(thing):
    """Points (p, 3) and corners (m, 3) of an object of a 3MF model."""
    points = [[float(v.get(axis)) for axis in "xyz"] for v in thing.iter(f"{CORE}vertex")]
    corners = [[int(t.get(name)) for name in ("v1", "v2", "v3")] for t in thing.iter(f"{CORE}triangle")]
    return np.array(points), np.array(corners)


def volume_of(points, corners):
    """The volume within a closed mesh [mm³], by the divergence theorem."""
    a, b, c = (points[corners[:, i]] for i in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6


def is_manifold(corners):
    """Whether each directed edge has its opposite exactly once."""
    edges = [tuple(pair) for a, b, c in corners.tolist() for pair in ((a, b), (b, c), (c, a))]
    return len(set(edges)) == len(edges) and {(b, a) for a, b in edges} == set(edges)


@quick_for(*DRAWN)
def test_a_3mf_package_holds_each_part_closed_at_its_positions(example_of, model):
    step = example_of(model).step
    bodies = read_step(step)
    read = model_of(derive(step, "3mf"))
    assert read.get("unit") == "millimeter"
    objects = read.findall(f".//{CORE}object")
    assert [one.get("name") for one in objects] == [body.name for body in bodies]
    corners = []
    meshes = {one.get("id"): mesh_of(one) for one in objects}
    for body, (points, triangles) in zip(bodies, meshes.values(), strict=True):
        assert is_manifold(triangles)
        assert volume_of(points, triangles) == pytest.approx(body.shape.Volume(), rel=0.02)
    for item in read.findall(f".//{CORE}item"):
        numbers = np.array([float(text) for text in item.get("transform").split()]).reshape(4, 3)
        corners.append(meshes[item.get("objectid")][0] @ numbers[:3] + numbers[3])
    box = bounding_box(bodies)
    size = max(np.subtract(box.high, box.low))
    assert np.min(np.concatenate(corners), axis=0) == pytest.approx(box.low, abs=2e-3 * size)
    assert np.max(np.concatenate(corners), axis=0) == pytest.approx(box.high, abs=2e-3 * size)
    assert len(corners) == sum(len(body.places) for body in bodies)


@quick_for(*DRAWN)
def test_a_brep_file_holds_the_same_solids(example_of, model):
    step = example_of(model).step
    bodies = read_step(step)
    read = cadquery.Shape.importBrep(io.BytesIO(derive(step, "brep")))
    placed = [body.shape.moved(place) for body in bodies for place in body.places]
    assert read.isValid()
    assert len(read.Solids()) == sum(len(shape.Solids()) for shape in placed)
    assert len(read.Faces()) == sum(len(shape.Faces()) for shape in placed)
    volume = sum(measure(body).volume * len(body.places) for body in bodies)
    assert measure(Body("all", read, STEEL, ())).volume == pytest.approx(volume, rel=1e-9)
    assert derive(step, "brep") == derive(step, "brep")


@quick_for(*DRAWN)
def test_an_stl_file_of_one_part_is_closed_and_has_its_volume(example_of, model):
    step = example_of(model).step
    for body in read_step(step):
        try:
            one = closed_mesh(body)
        except GeometryError:
            pytest.fail(f"{body.name} has no closed mesh")
        data = derive(step, with_part("stl", body.name))
        (count,) = struct.unpack_from("<I", data, 80)
        assert count == len(one.triangles)
        records = np.frombuffer(
            data, np.dtype([("n", "<f4", 3), ("p", "<f4", (3, 3)), ("a", "<u2")]), offset=84
        )
        points = records["p"].reshape(-1, 3)
        unique, numbers = np.unique(points, axis=0, return_inverse=True)
        assert is_manifold(numbers.reshape(-1, 3))
        assert volume_of(unique, numbers.reshape(-1, 3)) == pytest.approx(body.shape.Volume(), rel=0.02)


def test_options_are_read_back_from_a_kind():
    kind = with_part(with_deflection("stl", "0.05 mm"), "upper@shell")
    assert kind == "stl@0.05mm#upper@shell"
    assert plain_kind(kind) == "stl"
    assert {plain_kind(with_part(kind, "a#b")) for kind in BY_PART} == set(BY_PART)


@quick_for(("connecting_rod", 1))
def test_a_step_file_of_one_part_holds_its_solid_its_tolerances_and_its_properties(model):
    """The stamp writes material and mass; every tolerance on faces is in the file of its part."""
    texts = as_text(model.from_quantities(model.example))
    for name, text in texts.items():
        if name in model.toleranced and not text.startswith(("0 ", "[")):
            texts[name] = f"{text} +0.05/-0.01 mm"
    build = regenerate_class(model, texts)
    found = set()
    for body in read_step(build.step):
        data = derive(build.step, with_part("step", body.name))
        assert data == derive(build.step, with_part("step", body.name))
        (alone,) = read_step(data)
        assert (alone.name, len(alone.places), alone.places[0].toTuple()) == (body.name, 1, ((0,) * 3,) * 2)
        assert alone.colour == pytest.approx(body.colour, abs=1e-6)
        assert alone.shape.Volume() == pytest.approx(body.shape.Volume(), rel=1e-9)
        assert len(alone.shape.Faces()) == len(body.shape.Faces())
        header = read_header(data)
        assert (header.build, header.parameters[ONLY_PART]) == (build.key, body.name)
        stated = [(one.kind, one.name) for one in read_statements(data)]
        assert ("volume", body.name) in stated
        found.update(name.removesuffix("/2") for kind, name in set(stated) if kind == "dimension")
        stamp = Stamp("My engine", "rod", 3, "2026-01-02", build.materials, part=body.name)
        copy = stamped(data, "step", stamp)
        assert is_copy(copy, data)
        ((id, name, said),) = re.findall(rb"= PRODUCT\('([^']*)',\s*'([^']*)',\s*'([^']*)'", copy)
        assert (id.decode(), name.decode()) == (f"My_engine_rod_{body.name}", body.name)
        density = float(re.search(r"([0-9.]+) kg/m", build.materials[body.name])[1])
        mass = float(re.search(rb"mass ([0-9.e+-]+) kg", said)[1])
        assert mass == pytest.approx(density * body.shape.Volume() * 1e-9, rel=1e-3)
        assert build.materials[body.name].partition(" (")[0].encode() in said
        assert b"_FORMATION('3'" in copy
    carried = {name for name, place in build.tolerances.items() if place.faces}
    assert carried - of_several_parts(build) <= found <= carried


def of_several_parts(build):
    """The parameters whose sizes are on faces of several parts, perhaps between two of them."""
    return {name for name, place in build.tolerances.items() if len({part for part, _ in place.faces}) > 1}


@pytest.mark.parametrize("kind", ["validated.step", "svg", "png"])
def test_a_kind_that_always_holds_all_parts_refuses_one(kind):
    with pytest.raises(InvalidInputs) as refused:
        with_part(kind, "ball")
    assert [(fault.name, fault.code) for fault in refused.value.faults] == [("part", "not_offered")]
    assert "step, glb, stl, 3mf, brep" in refused.value.faults[0].detail


def test_an_unknown_part_is_refused_with_the_names_of_all(example_of):
    from cad.catalogue import models

    step = example_of(models().get("ball_bearing", 1)).step
    with pytest.raises(InvalidInputs) as refused:
        derive(step, with_part("stl", "bal"))
    assert "inner_ring, outer_ring, ball" in refused.value.faults[0].detail
