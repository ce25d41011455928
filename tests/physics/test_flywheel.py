"""Analytic: the energy fluctuation of a flywheel is right for a torque in closed form."""

import numpy as np
import pytest

from templates.physics.engine.flywheel import energy_fluctuation
from templates.physics.numerics.crank_grid import crank_grid

GRID = crank_grid(np.asarray(4), np.radians(0.5), np.radians([100.25, 611.0]))
THETA = GRID.theta


def test_analytic_swing_of_one_torque_about_its_mean():
    """The integral of A sin(n theta) runs from 0 to 2 A/n."""
    assert energy_fluctuation(70 + 30 * np.sin(3 * THETA), GRID) == pytest.approx(2 * 30 / 3, rel=1e-3)


def test_analytic_swing_of_a_table_of_torques():
    """Two axes of points before the angle, as a table of loads and speeds has."""
    sizes = np.array([[10.0, 20.0, 30.0], [40.0, 50.0, 60.0]])
    torque = sizes[..., None] * np.sin(2 * THETA) + 5
    assert energy_fluctuation(torque, GRID) == pytest.approx(sizes, rel=1e-3)
