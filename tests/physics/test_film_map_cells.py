"""The error that a map states at a point is the measured error of the point's cell."""

import numpy as np
import pytest

from templates.physics.films.film_map import film_map, map_error


@pytest.mark.parametrize("row", [0.0, 0.3, 0.5, 0.97])
@pytest.mark.parametrize("column", [0.0, 0.2, 0.6, 0.99])
def test_analytic_the_cell_of_a_point(row, column):
    data = film_map()
    rows, columns = data.error.shape[:2]
    x, y = (
        axis.first + share * axis.step * (axis.nodes - 1) + 1e-9
        for axis, share in ((data.eccentricity, row), (data.width, column))
    )
    error = map_error(np.tanh(x), np.exp(y))
    assert error.tolist() == data.error[int(row * rows), int(column * columns)].tolist()


def test_property_points_beyond_the_last_cell_belong_to_it():
    data = film_map()
    assert map_error(np.array([1 - 1e-7]), np.array([100.0]))[0].tolist() == data.error[-1, -1].tolist()
