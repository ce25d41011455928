"""engine 2: the exact balance of 28 layouts by pins, firing angles and order; both senses of banks."""

import numpy as np
import pytest
from balance_facts import PITCH, SPEED, UNITS, degrees, facts, numbers, order_of, sizes
from nine_cylinders import INPUTS as NINE

from templates.bearing_load.engine_v1 import Engine
from templates.bearing_load.flywheel_v1 import Flywheel
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate

ROWS = facts()
every_layout = pytest.mark.parametrize("row", ROWS, ids=[row["engine"] for row in ROWS])
UNBALANCE = [
    "rotating_force", "rotating_couple", "order_force_forward", "order_force_backward",
    "order_couple_forward", "order_couple_backward", "crankpin_angles", "ignition_angles", "layout",
]  # fmt: skip


def values(raw, outputs=None):
    return {name: answer.value for name, answer in evaluate(Engine, raw, outputs=outputs).outputs.items()}


def refused(raw):
    with pytest.raises(InvalidInputs) as refusal:
        evaluate(Engine, raw)
    return {name: fault.detail for fault in refusal.value.faults for name in fault.names}


def assert_facts(row, out):
    """All amplitudes of a row to 1e-10 of its units."""
    assert out["rotating_force"] / UNITS["rotating"] == pytest.approx(
        float(row["rotating_force"]), rel=0, abs=1e-10
    )
    assert out["rotating_couple"] / UNITS["rotating"] / PITCH == pytest.approx(
        float(row["rotating_couple"]), rel=0, abs=1e-10
    )
    for k, order in enumerate(("primary", "secondary")):
        for kind, arm in (("force", 1), ("couple", PITCH)):
            for sense in ("forward", "backward"):
                size = out[f"order_{kind}_{sense}"][k] / UNITS[order] / arm
                fact = float(row[f"{order}_{kind}_{sense}"])
                assert size == pytest.approx(fact, rel=0, abs=1e-10), (order, kind, sense)


def around(angles, period):
    """Angles from the first, within a period."""
    turned = (np.asarray(angles) - angles[0]) % period
    return np.where(period - turned < 1e-9, 0.0, turned)


class TestLiteratureBalance:
    def test_literature_all_rows_are_there(self):
        assert len(ROWS) == 28
        assert sum(row["engine"].startswith("trap") for row in ROWS) == 2

    @every_layout
    def test_literature_by_pins_and_firing_order(self, row):
        """With the firing angles that the row calls the most even."""
        raw = {**sizes(row), "pin_angles": degrees(numbers(row["pin_angles"])), "firing_order": order_of(row)}
        out = values(raw, UNBALANCE)
        assert_facts(row, out)
        cycle = 180 * int(row["strokes"])
        assert around(out["ignition_angles"], cycle) == pytest.approx(
            around(numbers(row["firing_angles"]), cycle), abs=1e-9
        )

    @every_layout
    def test_literature_by_pins_alone_without_gas(self, row):
        """Balance follows from the pins: a firing order is not needed, and none is stated."""
        raw = {**sizes(row), "pin_angles": degrees(numbers(row["pin_angles"])), "gas_cycle": "none"}
        out = values(raw, UNBALANCE)
        assert_facts(row, out)
        if raw["strokes"] == 4:
            assert out["ignition_angles"] is None or np.isnan(out["ignition_angles"]).all()
            assert out["layout"].endswith("no firing order")

    @every_layout
    def test_literature_by_firing_angles_alone(self, row):
        """The pins follow, up to a common turn of the reference line."""
        out = values({**sizes(row), "firing_angles": degrees(numbers(row["firing_angles"]))}, UNBALANCE)
        assert_facts(row, out)
        assert around(out["crankpin_angles"], 360) == pytest.approx(
            around(numbers(row["pin_angles"]), 360), abs=1e-9
        )

    def test_literature_firing_order_alone_makes_the_pins_of_both_bank_signs(self):
        """1-8-4-3-6-5-7-2: banks +45 −45 share pins, −45 +45 have pins 180° apart on each throw."""
        pair = [
            row
            for row in ROWS
            if "V8" in row["engine"] and ("order" in row["engine"] or "trap" in row["engine"])
        ]
        assert len(pair) == 2
        for row in pair:
            out = values({**sizes(row), "firing_order": [1, 8, 4, 3, 6, 5, 7, 2]}, UNBALANCE)
            assert_facts(row, out)
            assert out["crankpin_angles"] == pytest.approx(numbers(row["pin_angles"]), abs=1e-9)

    def test_literature_even_orders_alone_make_their_rows(self):
        """Where the intervals are equal, the order says all."""
        compared = 0
        for row in ROWS:
            order = order_of(row)
            intervals = np.diff(np.sort(numbers(row["firing_angles"])))
            if len(order) > 1 and np.ptp(intervals) < 1e-9:
                if abs(intervals[0] * len(order) - 180 * int(row["strokes"])) < 1e-9:
                    assert_facts(row, values({**sizes(row), "firing_order": order}, UNBALANCE))
                    compared += 1
        assert compared > 15


class TestBankSigns:
    TRAPS = [row for row in ROWS if row["engine"].startswith("trap")]

    @pytest.mark.parametrize("row", TRAPS, ids=lambda row: row["engine"])
    def test_property_turned_signs_are_refused_on_shared_pins(self, row):
        count = len(numbers(row["pin_angles"]))
        throws = (np.arange(count) // 2 + 1).tolist()
        raw = {**sizes(row), "firing_angles": degrees(numbers(row["firing_angles"])), "throws": throws}
        faults = refused(raw)
        assert "throws" in faults
        assert "turn the sign of `bank_angles`" in faults["throws"]
        out = values({**raw, "pins_of_a_throw": "split"}, ["pin_split"])
        assert out["pin_split"] == pytest.approx(180, abs=1e-9)

    def test_property_split_pins_of_the_even_V6_stand_30_degrees_apart(self):
        row = next(row for row in ROWS if "split" in row["engine"])
        raw = {
            **sizes(row),
            "firing_angles": degrees(numbers(row["firing_angles"])),
            "throws": [1, 1, 2, 2, 3, 3],
        }
        assert "throws" in refused(raw)
        assert values({**raw, "pins_of_a_throw": "split"})["pin_split"] == pytest.approx(30, abs=1e-9)


class TestAngles:
    @every_layout
    def test_analytic_largest_force_and_couple_against_a_search_over_the_turn(self, row):
        """At the stated crank angle, in the stated direction, by sums of cosines."""
        pins = numbers(row["pin_angles"])
        out = values({**sizes(row), "pin_angles": degrees(pins), "firing_order": order_of(row)})
        bank, psi, arm = (
            np.radians(numbers(row["bank_angles"])),
            np.radians(pins),
            PITCH * numbers(row["positions"]),
        )
        for k, order in enumerate(("primary", "secondary")):
            for kind, weight in (("force", 1 + 0 * arm), ("couple", arm)):

                def vector(theta, weight=weight, k=k, order=order):
                    waves = np.cos((k + 1) * (np.atleast_1d(theta)[:, None] + psi - bank))
                    return UNITS[order] * (weight * waves * np.exp(1j * bank)).sum(axis=1)

                size = out[f"order_{kind}_forward"][k] + out[f"order_{kind}_backward"][k]
                unit = UNITS[order] * PITCH
                assert np.abs(vector(np.linspace(0, 2 * np.pi, 721))).max() <= size + 1e-9 * unit
                there = vector(np.radians(out[f"order_{kind}_crank_angle"][k]))[0]
                towards = np.exp(1j * np.radians(out[f"order_{kind}_direction"][k]))
                assert there == pytest.approx(size * towards, abs=1e-8 * unit), (order, kind)

    def test_analytic_rotating_couple_of_the_cross_plane_four_by_hand(self):
        """ΣzF is −1.5 − 0.5i − 0.5i − 1.5 = −3 − i."""
        row = next(row for row in ROWS if row["engine"] == "in-line 4 cross-plane")
        raw = {**sizes(row), "pin_angles": degrees(numbers(row["pin_angles"])), "firing_order": order_of(row)}
        out = values(raw, ["rotating_couple", "rotating_couple_angle"])
        vector = out["rotating_couple"] * np.exp(1j * np.radians(out["rotating_couple_angle"]))
        assert vector == pytest.approx((-3 - 1j) * UNITS["rotating"] * PITCH, rel=1e-12)


class TestOrders:
    ROW = next(row for row in ROWS if row["engine"] == "single")

    def test_analytic_exact_harmonics_of_a_centred_crank(self):
        """x″ by an independent series: by quadrature of the position; odd ones vanish."""
        raw = {**sizes(self.ROW), "firing_order": [1], "orders": [1, 2, 3, 4, 6], "harmonics": "exact"}
        out = values(raw, ["order_force_forward", "order_force_backward"])
        lam = 0.05 / 0.16
        alpha = (np.arange(4096) + 0.5) * 2 * np.pi / 4096
        x = 0.05 * np.cos(alpha) + 0.16 * np.sqrt(1 - lam**2 * np.sin(alpha) ** 2)
        for k, h in enumerate([1, 2, 3, 4, 6]):
            coefficient = 2 * np.mean(x * np.cos(h * alpha)) * h**2
            expected = 0.8 * SPEED**2 * abs(coefficient) / 2 if h != 3 else 0.0
            assert out["order_force_forward"][k] == pytest.approx(expected, rel=1e-9, abs=1e-9)
        assert 0.8 * SPEED**2 * 0.05 * lam**3 / 8 == pytest.approx(out["order_force_forward"][3], rel=lam**2)

    def test_orders_are_one_list(self):
        raw = {**sizes(self.ROW), "firing_order": [1], "orders": [[1, 2], [4, 6]]}
        with pytest.raises(InvalidInputs, match="The orders are a single list"):
            values(raw, ["order_force_forward"])

    def test_analytic_offset_makes_odd_orders(self):
        raw = {**sizes(self.ROW), "firing_order": [1], "orders": [1, 2, 3], "cylinder_offset": "8 mm"}
        assert values(raw)["order_force_forward"][2] > 1

    def test_literature_lanchester_shafts_take_the_secondary_force_of_the_four(self):
        """Two at twice the speed against each other, each m_b r_b = m_rec r²/(2 l)."""
        row = next(row for row in ROWS if row["engine"] == "in-line 4 flat")
        raw = {**sizes(row), "firing_order": [1, 3, 4, 2], "crank_angle_step": "1 deg"}
        each = 0.8 * 50**2 / (2 * 160)
        shafts = {
            "balancer_unbalance": {"value": [each, each], "unit": "kg*mm"},
            "balancer_ratios": [2, -2],
            "balancer_phases": "180 deg",
            "balancer_positions": {"value": [0, 0], "unit": "mm"},
        }

        def second(**more):
            out = values({**raw, **more}, ["shaking_force_x", "shaking_force_y"])
            assert np.abs(out["shaking_force_y"]).max() < 1e-9 * UNITS["secondary"]
            return 2 * np.fft.fft(out["shaking_force_x"])[4].real / 720  # two turns of order 2

        whole = 4 * UNITS["secondary"]
        assert second() == pytest.approx(whole, rel=0.03)
        assert second(**shafts) == pytest.approx(second() - whole, abs=1e-9 * whole)


def test_literature_nine_cylinder_set_as_engine_1_has_it():
    """DYREMI's generator set: the couples of the version that prints its digits."""
    old = {name: answer.value for name, answer in evaluate(Flywheel, NINE).outputs.items()}
    assert round(old["rotating_couple"], 2) == 12127.84
    raw = {
        "speed": "1000 rpm", "strokes": 4, "crank_angle_step": "20 deg", "crank_radius": "150 mm",
        "rod_length": "600 mm", "bore": "0 mm", "rod_mass": "0 kg", "rod_centre": "0 mm",
        "piston_mass": "65 kg",
        "crank_unbalance": "3000 kg*mm", "gas_cycle": "none", "firing_order": NINE["firing_order"],
        "cylinder_positions": NINE["cylinder_positions"], "orders": [1, 2],
    }  # fmt: skip
    out = values(raw)
    assert round(out["rotating_couple"], 2) == 12127.84
    couples = out["order_couple_forward"] + out["order_couple_backward"]
    assert couples == pytest.approx([old["primary_couple"], old["secondary_couple"]], rel=1e-10)
