import io
import json
import struct
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image
from slow_models import DRAWN

from cad.export import DERIVED, derive
from cad.file_kinds import MEDIA_TYPES
from cad.inspect import measure
from cad.mesh import mesh
from cad.regenerate import Build
from cad.step import read_step

STL = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
QUICK_MODELS = DRAWN
PRINTED = "drawing.pdf"  # typeset of the picture of a drawing


def test_every_kind_has_a_media_type_and_can_be_had(files: dict[str, bytes]) -> None:
    assert set(MEDIA_TYPES) == {"step", *DERIVED}
    for kind in set(DERIVED) - {PRINTED}:
        assert len(files[kind]) > 100, kind


@pytest.mark.slow  # in the quick lane test_iso_drawing.py reads the PDF of one model
def test_every_drawing_can_be_had_as_pdf(files: dict[str, bytes]) -> None:
    assert files[PRINTED].startswith(b"%PDF-")


def test_unknown_kind_is_refused(example: Build) -> None:
    with pytest.raises(KeyError):
        derive(example.step, "exe")


def test_derived_files_are_the_same_each_time(example: Build, files: dict[str, bytes]) -> None:
    assert {kind: derive(example.step, kind) for kind in ("glb", "stl", "svg")} == {
        kind: files[kind] for kind in ("glb", "stl", "svg")
    }


def test_stl_encloses_the_volume(example: Build, files: dict[str, bytes]) -> None:
    triangles = np.frombuffer(files["stl"], STL, offset=84)
    assert struct.unpack_from("<I", files["stl"], 80) == (len(triangles),)
    a, b, c = triangles["corners"].astype(float).transpose(1, 0, 2)
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6  # divergence theorem
    assert volume == pytest.approx(example.measures["volume"], rel=0.01)


def test_stl_is_closed(files: dict[str, bytes]) -> None:
    triangles = np.frombuffer(files["stl"], STL, offset=84)
    a, b, c = triangles["corners"].astype(float).transpose(1, 0, 2)
    areas = np.cross(b - a, c - a) / 2
    assert np.abs(areas.sum(axis=0)).max() < 1e-5 * np.linalg.norm(areas, axis=1).sum()


def test_glb_is_a_scene_in_metres(example: Build, files: dict[str, bytes]) -> None:
    data = files["glb"]
    magic, version, length, json_length, kind = struct.unpack_from("<4sIII4s", data)
    content = json.loads(data[20 : 20 + json_length])
    assert (magic, version, length, kind) == (b"glTF", 2, len(data), b"JSON")
    assert content["asset"]["version"] == "2.0"
    assert len(content["nodes"]) == 1 + sum(len(body.places) for body in read_step(example.step))
    assert content["nodes"][0]["matrix"][0] == 1e-3
    assert content["buffers"][0]["byteLength"] <= len(data) - 28 - json_length
    for accessor in content["accessors"]:
        view = content["bufferViews"][accessor["bufferView"]]
        size = {"VEC3": 12, "SCALAR": 4}[accessor["type"]]
        assert accessor["count"] * size == view["byteLength"]
        assert view["byteOffset"] % 4 == 0


def test_normals_point_outwards(example: Build) -> None:
    for body in read_step(example.step):
        one = mesh(body)
        a, b, c = one.points[one.triangles].transpose(1, 0, 2)
        flat = np.cross(b - a, c - a)
        assert (np.einsum("ij,ij->i", flat, one.normals[one.triangles].mean(axis=1)) > 0).mean() > 0.999
        assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6 == pytest.approx(
            measure(body).volume, rel=0.01
        )


def test_svg_is_a_drawing_true_to_scale(files: dict[str, bytes]) -> None:
    root = ElementTree.fromstring(files["svg"])
    _, _, width, _ = map(float, root.attrib["viewBox"].split())
    paths = root.findall(".//{http://www.w3.org/2000/svg}path")
    assert root.attrib["width"].endswith("mm")
    assert float(root.attrib["width"].removesuffix("mm")) == pytest.approx(width, rel=1e-3)
    assert all(len(path.attrib["d"]) > 100 for path in paths)
    assert "nan" not in files["svg"].decode()


def test_png_is_a_picture(files: dict[str, bytes]) -> None:
    picture = np.asarray(Image.open(io.BytesIO(files["png"])).convert("RGB"), dtype=int)
    painted = (picture != 255).any(axis=2)
    assert picture.shape == (480, 640, 3)
    assert 0.1 < painted.mean() < 0.9
    assert not painted[[0, -1], :].any()
    assert not painted[:, [0, -1]].any()
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 100
