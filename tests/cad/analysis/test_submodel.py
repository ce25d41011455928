"""Parts of a solid: boxes about high stress, faces that are cut, and the motion of the whole at them."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial import cKDTree

from benchmarks.shoulder_fillet import END, FILLET, NARROW, SHOULDER, WIDE, shoulder
from cad.analysis.mesh import Near
from cad.analysis.solid import FREE, HELD, LOADED, MIRROR, read_solid
from cad.analysis.submodel import CUT, Motion, Region, cut_out, regions
from cad.shaft import Shaft

AT_FILLET = Near((0.0, NARROW / 2, SHOULDER + FILLET), 1.0, 0.5)


@pytest.fixture(scope="module")
def shaft():
    return read_solid(shoulder(FILLET), Shaft(0.0, END))


def test_boxes_that_meet_become_one_and_others_stay(shaft) -> None:
    far = Near((0.0, NARROW / 2, END), 1.0, 0.5)
    beside = Near((0.0, NARROW / 2, SHOULDER + FILLET + 3.0), 1.0, 0.5)
    boxes = regions([AT_FILLET, far, beside], shaft)
    assert len(boxes) == 2
    assert not boxes[0].meets(boxes[1])
    for place in (AT_FILLET, far, beside):
        assert sum(bool(box.holds(np.array(place.point))) for box in boxes) == 1


def test_a_box_holds_no_points_near_its_cuts() -> None:
    box = Region(np.zeros(3), np.full(3, 10.0), 4.0)
    assert box.holds(np.array([[5, 5, 5], [2.1, 5, 5], [1.9, 5, 5], [5, 5, 8.1]])).tolist() == [
        True, True, False, False,
    ]  # fmt: skip


def test_what_is_cut_out_keeps_the_names_of_its_faces(shaft) -> None:
    at_plane = Near((NARROW / 2, 0.5, SHOULDER + FILLET), 1.0, 0.5)
    part = cut_out(shaft, regions([at_plane], shaft))
    assert {face.name for face in part.shape.faces} == {CUT, FREE, MIRROR}
    assert part.scale == pytest.approx(shaft.scale)
    assert part.mirror == shaft.mirror
    whole = cut_out(shaft, [Region(np.full(3, -WIDE), np.full(3, 2 * END), 1.0)])
    assert whole.shape.mass == pytest.approx(shaft.shape.mass, rel=1e-9)
    assert {face.name for face in whole.shape.faces} == {FREE, MIRROR, HELD, LOADED}


def test_property_a_cubic_motion_is_carried_over_exactly() -> None:
    """Also at points beyond all those that it is fitted to, as at a surface that is curved."""
    rng = np.random.default_rng(5)

    def cubic(points):
        x, y, z = points.T
        return np.stack([x**3 - y * z, x * y * z + 2, z**2 * y - x], axis=1)

    motion = Motion.__new__(Motion)
    motion.points = rng.uniform(0, 1, (4000, 3))
    motion.moved, motion.tree = cubic(motion.points), cKDTree(motion.points)
    points = rng.uniform(-0.01, 1.01, (500, 3))
    assert_allclose(motion.at(points), cubic(points), atol=1e-6)
