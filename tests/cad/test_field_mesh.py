"""Fields on the surface of a crankshaft have the right positions and colours in a GLB file."""

import io
import json
from math import cos, pi, sin

import numpy as np
import pytest
from PIL import Image

from cad.cranks.chain_throw import shaft_of_throws, sizes_of_throw
from cad.cranks.shaft_fields import along_shaft, at_fillets, in_throw, places_of
from cad.field_mesh import Field, Glb
from cad.gltf import write_glb
from cad.mesh import closed_mesh
from cad.models.crankshaft_v1 import Crankshaft
from cad.step import Body

SIZES = {
    "pin_angles": {"value": [0, 90], "unit": "deg"}, "journal_diameter": "55 mm", "journal_length": "26 mm",
    "pin_diameter": "48 mm", "pin_length": "32 mm", "web_thickness": "18 mm", "web_width": "80 mm",
    "throw": "43 mm", "fillet": "3 mm",
}  # fmt: skip
BARE = [0.74, 0.76, 0.79]
VIOLET, YELLOW = (np.array(one) / 255 for one in ((0x44, 0x01, 0x54), (0xFD, 0xE7, 0x25)))


@pytest.fixture(scope="module")
def shaft():
    shape = Crankshaft.from_quantities(SIZES)
    return shaft_of_throws(shape)


@pytest.fixture(scope="module")
def drawn(shaft):
    body = Body("shaft", shaft.solid(), (0.5, 0.5, 0.5), (_here(),))
    return write_glb([closed_mesh(body)], "model", {("shaft", 0): ("pin_diameter",)})


def _here():
    from cadquery import Location

    return Location()


def points_of(sizes):
    """A point every 15° round each of the four fillets."""
    points = []
    for ring in sizes.rings():
        radius, z = (ring.inner + ring.outer) / 2, (ring.low + ring.high) / 2
        points += [[ring.axis + radius * cos(a), radius * sin(a), z] for a in np.arange(24) * pi / 12 + 0.01]
    return np.array(points)


def test_only_fillets_are_painted_and_both_throws_alike(shaft, drawn):
    sizes, glb = sizes_of_throw(shaft), Glb(drawn)
    points = points_of(sizes)
    values = np.repeat([1.0, 2.0, 3.0, 4.0], 24)  # of the rings: pin low, pin high, journal low, high
    painted = at_fillets(sizes, places_of(shaft), glb.points, glb.faces, points, values)
    there = np.isfinite(painted)
    for angle, middle in places_of(shaft):
        own = in_throw(glb.points, angle, middle)
        for number, ring in enumerate(sizes.rings()):
            here = there & ring.holds(own)
            assert here.sum() > 40
            assert painted[here] == pytest.approx(number + 1)
    x, y, _ = glb.points.T
    from_pins = [np.hypot(*in_throw(glb.points, *place)[:, :2].T - [[43], [0]]) for place in places_of(shaft)]
    between_fillets = [
        (abs(away - 24) < 1e-3) & (abs(in_throw(glb.points, *place)[:, 2]) < 12.9)
        for away, place in zip(from_pins, places_of(shaft), strict=True)
    ]
    assert not there[np.any(between_fillets, axis=0)].any()
    assert not there[np.hypot(x, y) > 70].any()  # tips of the webs


def test_round_a_fillet_a_value_is_linear_in_the_angle(shaft, drawn):
    sizes, glb = sizes_of_throw(shaft), Glb(drawn)
    points = points_of(sizes)
    pin, turn = sizes.rings()[1], shaft.throws[1].angle
    angles = np.arctan2(points[:, 1], points[:, 0] - np.where(np.arange(96) < 48, 43, 0))
    values = np.cos(angles)
    painted = at_fillets(sizes, places_of(shaft), glb.points, glb.faces, points, values)
    own = in_throw(glb.points, turn, shaft.pitch * 1.5)
    here = np.isfinite(painted) & pin.holds(own)
    assert painted[here] == pytest.approx(np.cos(np.arctan2(own[here, 1], own[here, 0] - 43)), abs=0.01)


def test_a_mode_goes_from_end_to_end(shaft, drawn):
    glb = Glb(drawn)
    angles = along_shaft(shaft, glb.points, [0.5, -0.25], (1.0, -1.0))
    z = glb.points[:, 2]
    assert angles[np.argmin(z)] == pytest.approx(1)
    assert angles[np.argmax(z)] == pytest.approx(-1)
    middle = np.argmin(abs(z - shaft.pitch))
    assert angles[middle] == pytest.approx(0.125 - 0.75 * (z[middle] / shaft.pitch - 1), abs=1e-9)
    assert (np.diff(angles[np.argsort(z)]) <= 1e-12).all()


def test_a_glb_has_the_colours_and_the_rest_of_its_file(drawn):
    glb = Glb(drawn)
    values = np.where(glb.points[:, 2] > 0, glb.points[:, 2], np.nan)
    field = Field("height", "mm", values, 0.0, float(np.nanmax(values)))
    written = glb.painted(field)
    again = Glb(written)
    assert np.array_equal(again.points, glb.points)
    assert np.array_equal(again.triangles, glb.triangles)
    assert int.from_bytes(written[8:12], "little") == len(written)
    assert again.about["buffers"][0]["byteLength"] == len(again.binary)
    accessor = again.about["accessors"][again.attributes["COLOR_0"]]
    assert (accessor["count"], accessor["type"]) == (len(glb.points), "VEC3")
    assert again.about["nodes"][0]["extras"] == {
        "field": "height", "unit": "mm", "low": 0.0, "high": field.high,
    }  # fmt: skip
    colours = field.colours()
    assert colours[np.nanargmax(values)] == pytest.approx(YELLOW)
    assert colours[np.isnan(values)] == pytest.approx(np.tile(BARE, (np.isnan(values).sum(), 1)))
    assert json.loads(json.dumps(again.about)) == again.about


def test_a_constant_field_has_the_first_colour():
    assert Field("", "1", np.ones(3), 1.0, 1.0).colours() == pytest.approx(np.tile(VIOLET, (3, 1)))


def test_a_picture_shows_the_field(drawn):
    glb = Glb(drawn)
    high = np.ones(len(glb.points))
    yellow, violet = (
        np.asarray(Image.open(io.BytesIO(glb.picture(Field("", "1", one * high, 0.0, 1.0)))).convert("RGB"))
        for one in (1.0, 0.0)
    )
    part = (yellow < 250).any(axis=2) & (violet < 250).any(axis=2)
    assert part.mean() > 0.05
    assert (yellow[part][:, 1] > violet[part][:, 1]).mean() > 0.9  # green light: the scale is ordered by it
