"""Each face of a STEP or GLB file names the parameters that it carries; a second reader compares them."""

import re

import numpy as np
import pytest
from part21_reader import File
from slow_models import DRAWN
from test_meshes import glb

from cad.catalogue import models
from cad.export import derive
from cad.face_marks import face_marks, marked, read_marks
from cad.inspect import look_at
from cad.step import read_step
from cad.surfaces import Size

QUICK_MODELS = DRAWN


def bare(step):
    """The file without marks, as files of older recipes are."""
    return re.sub(rb"ADVANCED_FACE\('[^']*'", b"ADVANCED_FACE(''", step)


def sizes(model, step):
    """The dimensions that the faces of a file show."""
    built = model.from_quantities(model.example)
    shown = built.dimensions(look_at(read_step(step)))
    return {name: size for name, size in shown.items() if isinstance(size, Size)}


def test_cylinders_that_carry_a_diameter_have_it(model, example):
    file = File(example.step)
    surfaces = {}
    for number in file.of["ADVANCED_FACE"]:
        (name, _, surface, _) = file.entities[number]["ADVANCED_FACE"]
        ((keyword, arguments),) = file.entities[surface.number].items()
        for parameter in name.split():
            surfaces.setdefault(parameter, []).append((keyword, arguments))
    shown = sizes(model, example.step)
    assert surfaces.keys() == shown.keys()
    assert surfaces.keys() <= example.dimensions.keys()
    for name, size in shown.items():
        if size.kind == "diameter":
            assert {keyword for keyword, _ in surfaces[name]} == {"CYLINDRICAL_SURFACE"}
            radii = [arguments[2] for _, arguments in surfaces[name]]
            assert radii == pytest.approx([size / 2] * len(radii), abs=1e-9)


def test_marks_change_nothing_else_and_are_read_again(model, example):
    plain = bare(example.step)
    bodies = read_step(plain)
    marks = face_marks(sizes(model, plain))
    assert marked(plain, bodies, marks) == example.step
    assert dict(read_marks(example.step, bodies)) == dict(marks)
    assert read_marks(plain, bodies) == {}


def test_triangles_of_a_primitive_lie_on_the_faces_of_its_parameters(model, example, files):
    content, _ = glb(files["glb"])
    primitives = [(one["name"], p) for one in content["meshes"] for p in one["primitives"]]
    named = {
        (body, tuple(p["extras"]["parameters"])): p["indices"] for body, p in primitives if "extras" in p
    }
    assert named.keys() == {
        (part, names) for (part, _), names in face_marks(sizes(model, example.step)).items()
    }
    assert len(named) == sum("extras" in p for _, p in primitives)
    (plain, _), (whole, _) = glb(derive(bare(example.step), "glb")), glb(files["glb"])
    assert all(
        len(one["primitives"]) == 1 and "extras" not in one["primitives"][0] for one in plain["meshes"]
    )
    assert corners(plain) == corners(whole)


def corners(content):
    """The number of corners of each mesh."""
    return [
        sum(content["accessors"][p["indices"]]["count"] for p in one["primitives"])
        for one in content["meshes"]
    ]


def test_points_of_a_marked_bore_have_its_radius(example_of):
    build = example_of(models().get("plain_bearing", 1))
    data = derive(build.step, "glb")
    content, _ = glb(data)
    binary = data[28 + int.from_bytes(data[12:16], "little") :]
    radius = build.dimensions["inner_diameter"] / 2
    (lining,) = (one for one in content["meshes"] if one["name"] == "upper_lining")
    (bore,) = (
        p for p in lining["primitives"] if "inner_diameter" in p.get("extras", {}).get("parameters", ())
    )
    points, indices = (
        np.frombuffer(binary, kind, accessor["count"] * width, view["byteOffset"])
        for kind, width, number in (("<f4", 3, bore["attributes"]["POSITION"]), ("<u4", 1, bore["indices"]))
        for accessor in [content["accessors"][number]]
        for view in [content["bufferViews"][accessor["bufferView"]]]
    )
    places = points.reshape(-1, 3)[indices].astype(float)
    assert np.hypot(places[:, 0], places[:, 1]) == pytest.approx(np.full(len(places), radius), rel=1e-4)


def test_a_file_of_one_part_keeps_the_marks_of_its_faces(example_of):
    build = example_of(models().get("plain_bearing", 1))
    whole = read_marks(build.step, read_step(build.step))
    part = derive(build.step, "step#upper_lining")
    assert dict(read_marks(part, read_step(part))) == {
        f: n for f, n in whole.items() if f[0] == "upper_lining"
    }


def test_faces_that_are_not_those_of_the_bodies_stay_unmarked(example_of):
    build = example_of(models().get("flanged_bush", 1))
    plain = bare(build.step)
    (body,) = read_step(plain)
    assert marked(plain, [body, body], {("bush", 0): ("width",)}) == plain
