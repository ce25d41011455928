"""Analytic: each rule for a gas cycle's data is tested at the edge of the accepted range."""

import numpy as np
import pytest

from templates.physics.engine import gas_checks as checks
from templates.physics.engine.gas_pressure import NoGas, TabulatedCycle, one_cycle, peak_pressure

FOUR = np.asarray(4.0)


def degrees(*angles):
    return [np.radians(np.asarray(float(angle))) for angle in angles]


@pytest.mark.parametrize(
    ("events", "in_order"),
    [
        ((-15, 220, 490, 15), True),  # inlet opens, inlet closes, exhaust opens, exhaust closes
        ((90, 220, 490, -90), True),
        ((90.1, 220, 490, 15), False),
        ((-90.1, 220, 490, 15), False),
        ((-15, 220, 490, 90.1), False),
        ((-15, 220, 490, 719), True),  # 1° before the dead centre
        ((-15, 220, 490, 629), False),
        ((-15, 90, 490, 15), True),
        ((-15, 89.9, 490, 15), False),
        ((-15, 220, 630, 15), True),
        ((-15, 220, 630.1, 15), False),
    ],
)
def test_valves_open_and_close_near_the_dead_centre(events, in_order):
    assert bool(checks.valves_in_order(*degrees(*events))) is in_order


def test_a_value_is_asked_for_by_some_cycles_only():
    value = np.array([1.0, np.nan])
    assert np.all(checks.known_for("none", checks.POLYTROPIC, value))
    assert checks.known_for("otto", checks.POLYTROPIC, value).tolist() == [True, False]


def table(count, first=0.0, last=None, strokes=4):
    """Rising angles of a four-stroke cycle and pressures of as many values."""
    step = np.pi * strokes / count
    angle = first + step * np.arange(count) if last is None else np.linspace(first, last, count)
    return angle, 1e5 + 1e4 * np.arange(count)


class TestTable:
    def test_a_table_is_asked_for_by_its_cycle_only(self):
        assert checks.table_is_known("otto", np.asarray(np.nan))
        assert not checks.table_is_known("table", np.asarray(np.nan))
        assert checks.table_is_known("table", np.ones(9))

    def test_angles_rise_and_are_as_many_as_pressures(self):
        angle, p = table(12)
        assert checks.angles_rise("table", angle, p)
        assert checks.angles_rise("table", np.asarray(np.nan), p)
        assert checks.angles_rise("otto", angle[::-1], p)
        assert not checks.angles_rise("table", angle[::-1], p)
        assert not checks.angles_rise("table", np.repeat(angle[:6], 2), p)
        assert not checks.angles_rise("table", angle[:-1], p)
        assert not checks.angles_rise("table", np.stack([angle, angle]), np.stack([p, p]))
        assert checks.angles_rise("table", angle, np.stack([p, p]))

    @pytest.mark.parametrize(("count", "enough"), [(7, False), (8, True)])
    def test_eight_points_are_enough(self, count, enough):
        angle, p = table(count)
        assert checks.full_cycle("table", FOUR, angle, p) is enough
        assert checks.full_cycle("table", FOUR, np.asarray(np.nan), p) is enough
        assert checks.full_cycle("otto", FOUR, angle, p)

    @pytest.mark.parametrize(
        ("last", "whole"),
        [(4 * np.pi, True), (4 * np.pi * 11 / 12, True), (4 * np.pi * 10 / 12, False), (4.01 * np.pi, False)],
    )
    def test_the_table_covers_the_cycle(self, last, whole):
        """Its end is at most one of its steps from the begin of the next cycle, and not beyond."""
        angle, p = table(12, last=last)
        assert checks.full_cycle("table", FOUR, angle, p) is whole
        assert checks.full_cycle("table", FOUR, angle + 1, p) is whole

    def test_a_repeated_point_repeats_its_pressure(self):
        angle, p = table(13, last=4 * np.pi)
        assert not checks.table_closes("table", FOUR, angle, p)
        assert checks.table_closes("table", FOUR, angle, np.append(p[:-1], p[0] * (1 + 5e-7)))
        assert checks.table_closes("table", FOUR, *table(12))
        assert checks.table_closes("otto", FOUR, angle, p)

    def test_curves_fit_into_memory(self):
        """The internal grid has 720 angles at any step from 1 deg on, 7200 at 0.1 deg."""
        for degrees, most in ((1, 2777), (30, 2777), (0.1, 277)):
            assert checks.is_manageable((most,), FOUR, np.radians(degrees))
            assert not checks.is_manageable((most + 1,), FOUR, np.radians(degrees))


class TestPressure:
    def test_a_table_is_linear_between_its_points_and_goes_round(self):
        angle, p = table(12, first=0.5)
        gas = TabulatedCycle(angle, np.stack([p, 2 * p]), np.asarray([3.5, 4.0]), 4 * np.pi)
        step = angle[1] - angle[0]
        theta = np.array([0.5, 0.5 + 0.25 * step, 0.5 - 0.25 * step, angle[3] + 8 * np.pi])
        expected = np.array([p[0], 0.75 * p[0] + 0.25 * p[1], 0.75 * p[0] + 0.25 * p[-1], p[3]])
        pressure = gas.pressure(theta, np.zeros(4))
        assert pressure == pytest.approx(np.stack([expected, 2 * expected]))

    def test_a_table_without_angles_has_equal_steps(self):
        p = np.arange(10.0)
        angle, kept = one_cycle(np.asarray(np.nan), p, 5.0)
        assert angle == pytest.approx(0.5 * np.arange(10))
        assert kept.tolist() == p.tolist()

    def test_a_repeated_point_is_left_out(self):
        angle, p = table(13, last=4 * np.pi)
        short, kept = one_cycle(angle, np.stack([p, p]), 4 * np.pi)
        assert (short.size, kept.shape) == (12, (2, 12))
        assert one_cycle(*table(12), 4 * np.pi)[0].size == 12

    def test_no_gas_has_the_pressure_of_the_crankcase_and_no_peak(self):
        gas = NoGas(np.array([1e5, 2e5]))
        assert gas.pressure(np.zeros(3), np.zeros(3)).tolist() == [[1e5] * 3, [2e5] * 3]
        assert gas.mean_effective().tolist() == [0, 0]
        assert np.isnan(peak_pressure("none", np.ones((2, 3)))).tolist() == [True, True]
        assert peak_pressure("otto", np.array([[1.0, 3.0, 2.0]])).tolist() == [3]
