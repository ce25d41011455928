"""Pictures show a part in its usual position: a crankshaft lies, a bearing stands on its face."""

import io

import numpy as np
import pytest
from PIL import Image

from cad.catalogue import models
from cad.export import derive
from cad.view import view_of


def painted_box(png):
    """The width and height that the part takes, as shares of the picture."""
    paper = np.asarray(Image.open(io.BytesIO(png)).convert("RGB"), dtype=int)
    rows, columns = np.nonzero((paper != 255).any(axis=2))
    height, width = paper.shape[:2]
    return np.ptp(columns) / width, np.ptp(rows) / height


@pytest.mark.parametrize("extent", [(1.0, 1.0, 0.2), (1.0, 1.0, 1.4), (1.0, 1.0, 9.0), (2.0, 7.0, 1.0)])
def test_a_view_is_a_rotation(extent):
    view = view_of(np.array(extent))
    assert view.T @ view == pytest.approx(np.eye(3), abs=1e-15)
    assert np.linalg.det(view) == pytest.approx(1)


def test_a_long_part_runs_to_the_right_and_a_short_one_has_its_axis_upwards():
    lying, standing = view_of(np.array([1.0, 1.0, 5.0])), view_of(np.array([1.0, 1.0, 0.2]))
    assert lying[2, 0] > 0.8  # z to the right
    assert lying[1, 1] > 0.8  # y upwards
    assert standing[2, 0] == pytest.approx(0)
    assert standing[2, 1] > 0.8  # z upwards


@pytest.mark.parametrize("name", ["crankshaft", "plain_bearing", "connecting_rod"])
def test_a_part_fills_its_picture(example_of, name):
    width, height = painted_box(derive(example_of(models().get(name, 1)).step, "png"))
    assert max(width, height) > 0.85
    assert width > 0.85 or name != "crankshaft"
