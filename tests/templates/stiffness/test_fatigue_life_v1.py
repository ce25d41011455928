"""`fatigue_life` 1: ASTM's counting, closed forms of the criteria, superposition, Miner, what is refused."""

from math import pi, sqrt

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.physics.fatigue.endurance import size_factor, surface_factor
from templates.physics.fatigue.findley import critical_planes, findley_coefficient, uniaxial_equivalent
from templates.physics.fatigue.rainflow import by_rainflow, counted
from templates.physics.fatigue.smallest_circle import radii_of_smallest_circles
from templates.physics.fatigue.tensors import as_matrices, leading_tensor, signed_von_mises, von_mises_1913
from templates.stiffness.fatigue_life_v1 import FatigueLife

STEEL = {"ultimate_strength": "900 MPa", "endurance_limit": "300 MPa", "strength_at_1000_cycles": "700 MPa"}
TENSION, SHEAR = [0, 0, 1, 0, 0, 0], [0, 0, 0, 0, 1, 0]
ANGLES = np.linspace(0, 2 * pi, 73)[:-1]
K = 0.3


def loaded(force, stress=TENSION, **others):
    """A force in kN over the cycle, which makes so many MPa a kN at one point, or at several."""
    rows = stress if isinstance(stress[0], list) else [stress]
    return {**STEEL, "force_1": {"value": np.asarray(force, float).tolist(), "unit": "kN"},
            "stress_of_force_1": {"value": rows, "unit": "MPa/kN"}, **others}  # fmt: skip


def answers(raw, **options):
    return {n: a.value for n, a in evaluate(FatigueLife, raw, **options).outputs.items()}


def refused(raw):
    with pytest.raises(InvalidInputs) as refusal:
        evaluate(FatigueLife, raw)
    return {name for fault in refusal.value.faults for name in fault.names}


def cycle(amplitude, mean=0.0):
    return mean + amplitude * np.cos(ANGLES)


def history_of(parts):
    """A history of one point, of (component, curve) pairs."""
    tensors = np.zeros((1, len(ANGLES), 6))
    for component, values in parts:
        tensors[0, :, component] = values
    return tensors


def findley(tensors, k=K, *, credit=False):
    """The reversed uniaxial amplitude of each history."""
    plane = critical_planes(tensors, k, credit=credit)
    normal = plane.normal_high if credit else np.maximum(plane.normal_high, plane.normal_amplitude())
    return uniaxial_equivalent(plane.shear_amplitude + k * normal, k)


class TestLiterature:
    def test_literature_rainflow_of_astm_e1049(self):
        """Figure 6 of the standard, -2, 1, -3, 5, -1, 3, -4, 4, -2: ranges 3, 4, 6, 8, 9 and their counts.

        The standard counts halves: 3: ½, 4: 1½, 6: ½, 8: 1, 9: ½. Round from its highest point the same
        history closes its halves: the valley of -4 and the peak of 5 are one cycle of 9, -3 and 4 one of 7.
        """
        import rainflow

        history = [-2, 1, -3, 5, -1, 3, -4, 4, -2]
        assert rainflow.count_cycles(history) == [(3, 0.5), (4, 1.5), (6, 0.5), (8, 1.0), (9, 0.5)]
        closed = {2 * a: n for a, _, n in counted(np.array(history[:-1], float))}
        assert closed == {3: 1.0, 4: 1.0, 7: 1.0, 9: 1.0}

    def test_literature_shigley_s_life(self):
        """Example 6-2: 1050 HR, 90 ksi, f 0.86, S_e' 45 ksi: 64.6 ksi for 1e4 cycles, 7.7e4 cycles at 55."""
        raw = {"ultimate_strength": "90 ksi", "endurance_limit": "45 ksi",
               "strength_at_1000_cycles": {"value": 0.86 * 90, "unit": "ksi"}}  # fmt: skip
        for stress, life in ((64.6, 1e4), (55.0, 7.75e4)):
            force = stress * 6.894757 * np.array([1, -1])
            assert answers({**loaded(force), **raw})["cycles"] == pytest.approx(life, rel=0.02)

    def test_literature_shigley_s_fraction(self):
        """S_u 105 ksi: f = 0.837 by equation 6-10, in the text."""
        raw = loaded([1, -1], ultimate_strength="105 ksi")
        assert answers(raw)["strength_share"] == pytest.approx(0.837, abs=5e-4)

    @pytest.mark.parametrize(("reliability", "factor"), [(0.5, 1), (0.9, 0.897), (0.95, 0.868), (0.99, 0.814),
                                                         (0.999, 0.753)])  # fmt: skip
    def test_literature_reliability(self, reliability, factor):
        result = answers(loaded([1, -1], reliability=reliability))
        assert result["reliability_factor"] == pytest.approx(factor, abs=6e-4)

    def test_literature_factors_of_marin(self):
        assert surface_factor("machined", 520e6) == pytest.approx(0.86, abs=0.002)  # example 6-3
        assert surface_factor("polished", 520e6) == 1
        assert surface_factor("ground", 150e6) == 1  # the fit is above 1 there
        assert size_factor(np.float64(32e-3)) == pytest.approx(0.858, abs=0.003)  # example 6-4
        assert size_factor(np.float64(60e-3)) == pytest.approx(1.51 * 60**-0.157)
        assert size_factor(np.float64(np.nan)) == size_factor(np.float64(2e-3)) == 1

    def test_literature_notch_sensitivity(self):
        """Example 6-6: 690 MPa, r 3 mm, K_t 1.65: √a 0.0622 √in, q 0.847, K_f 1.55 (Neuber)."""
        result = answers(loaded([1, -1], ultimate_strength="690 MPa", notch_radius="3 mm",
                                stress_concentration_factor=1.65))  # fmt: skip
        assert result["notch_sensitivity"] == pytest.approx(0.847, abs=0.003)
        assert result["notch_support"] * 1.65 == pytest.approx(1.55, abs=0.005)


class TestFindley:
    def test_analytic_90_degrees_out_of_phase(self):
        """Tension and shear σ/√3: von Mises does not change, signed it swings by 1, Findley says 1.31."""
        tensors = history_of([(2, np.cos(ANGLES)), (4, np.sin(ANGLES) / sqrt(3))])
        assert np.ptp(von_mises_1913(tensors)) < 1e-12
        assert leading_tensor(tensors)[1] == pytest.approx(0.6, abs=0.01)
        assert np.ptp(signed_von_mises(tensors)) / 2 == pytest.approx(1)
        exact = 2 * (1 / sqrt(3) + K) / (K + sqrt(1 + K**2))
        assert findley(tensors) == pytest.approx(exact, rel=1e-7)
        assert exact == pytest.approx(1.31, abs=0.005)

    @pytest.mark.parametrize("mean", [0, 0.4, 2])
    @pytest.mark.parametrize("k", [0.1, 0.3, 1])
    def test_analytic_tension_with_its_mean(self, k, mean):
        parameter = (sqrt(1 + k**2 * (1 + mean) ** 2) + k * (1 + mean)) / 2
        expected = uniaxial_equivalent(parameter, k)
        assert findley(history_of([(0, cycle(1, mean))]), k) == pytest.approx(expected, rel=1e-7)

    @pytest.mark.parametrize("ratio", [1.2, 1.6, sqrt(3)])
    def test_analytic_reversed_torsion_is_f_over_t(self, ratio):
        k = findley_coefficient(ratio)
        assert findley(history_of([(3, cycle(1))]), float(k)) == pytest.approx(ratio, rel=1e-7)

    def test_property_rotation_changes_nothing(self):
        rng = np.random.default_rng(5)
        tensors = rng.normal(size=(30, len(ANGLES), 6))
        turned = []
        for matrix in Rotation.random(4, rng).as_matrix():
            full = matrix @ as_matrices(tensors) @ matrix.T
            turned.append(np.stack([full[..., i, j] for i, j in
                                    ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))], -1))  # fmt: skip
        for other in turned:
            assert findley(other) == pytest.approx(findley(tensors), rel=5e-4)
            assert von_mises_1913(other) == pytest.approx(von_mises_1913(tensors))
            assert leading_tensor(other)[1] == pytest.approx(leading_tensor(tensors)[1])

    def test_property_no_plane_of_a_fine_search_is_worse(self):
        """A second method: planes at random, half of the longest chord as a lower bound of the amplitude."""
        rng = np.random.default_rng(8)
        tensors = rng.normal(size=(1, 12, 6))
        directions = rng.normal(size=(4000, 3))
        directions /= np.linalg.norm(directions, axis=1)[:, None]
        traction = np.einsum("aij,nj->nai", as_matrices(tensors[0]), directions)
        normal = np.einsum("nai,ni->na", traction, directions)
        shear = traction - normal[..., None] * directions[:, None]
        half_chord = np.array([
            np.linalg.norm(s[:, None] - s[None], axis=-1).max() / 2 for s in shear
        ])  # fmt: skip
        least = (half_chord + K * normal.max(axis=1)).max()
        plane = critical_planes(tensors, K, credit=True)
        assert plane.shear_amplitude[0] + K * plane.normal_high[0] >= least * (1 - 1e-3)

    def test_property_the_mean_of_compression(self):
        pressed, without = history_of([(2, cycle(1, -3))]), history_of([(2, cycle(1))])
        assert findley(pressed) == pytest.approx(findley(without), rel=1e-6)
        assert findley(pressed, credit=True)[0] < findley(without)[0] * 0.9


class TestSmallestCircle:
    def test_analytic_circle_ellipse_and_line(self):
        x, y = np.cos(ANGLES), np.sin(ANGLES)
        paths = [(x, y, 1), (x, 0.3 * y, 1), (x, 0 * y, 1), (3 + 0 * x, 0 * y, 0), (2 * x, 2 * y - 7, 2)]
        for a, b, radius in paths:
            assert radii_of_smallest_circles(a, b) == pytest.approx(radius, abs=1e-12)

    def test_analytic_equilateral_triangle(self):
        corners = np.array([0, 2 * pi / 3, 4 * pi / 3])
        assert radii_of_smallest_circles(np.cos(corners), np.sin(corners)) == pytest.approx(1)

    def test_property_it_holds_all_points_and_no_smaller_one_does(self):
        """By every pair and triple of points."""
        rng = np.random.default_rng(1)
        for _ in range(20):
            points = rng.normal(size=9) + 1j * rng.normal(size=9)
            assert radii_of_smallest_circles(points.real, points.imag) == pytest.approx(tried(points))


def tried(points):
    """The smallest of all circles through two or three points that hold all."""
    best = np.inf
    for i, a in enumerate(points):
        for j, b in enumerate(points[:i]):
            centres = [(a + b) / 2]
            for c in points[:j]:
                p, q = b - a, c - a
                centres.append(a + 1j * (p * abs(q) ** 2 - q * abs(p) ** 2) / (2 * (p.conjugate() * q).imag))
            for centre in centres:
                radius = abs(a - centre)
                if np.all(abs(points - centre) <= radius * (1 + 1e-12)):
                    best = min(best, radius)
    return best


class TestLife:
    @pytest.mark.parametrize("criterion", ["findley", "signed_von_mises"])
    @pytest.mark.parametrize(("amplitude", "mean"), [(400, 0), (350, 100), (500, -200)])
    def test_analytic_constant_amplitude_is_the_closed_form(self, criterion, amplitude, mean):
        """Rainflow of one cycle is the level of the extremes, and both are the formula on paper."""
        raw = loaded(cycle(amplitude, mean), multiaxial_criterion=criterion)
        counted_, closed = answers(raw), answers(raw, level="extremes")
        used = max(mean, 0)
        if criterion == "findley":
            k = float(findley_coefficient(1.6))
            high = amplitude + used
            parameter = (sqrt(amplitude**2 + k**2 * high**2) + k * high) / 2
            equivalent = uniaxial_equivalent(parameter, k)
        else:
            equivalent = amplitude / (1 - used / 900)
        cycles = 1e3 * (equivalent / 700) ** (3 / np.log10(300 / 700))
        for result in (counted_, closed):
            assert result["equivalent_amplitude"][0] == pytest.approx(equivalent, rel=1e-6)
            assert result["cycles"] == pytest.approx(cycles, rel=1e-4)

    def test_analytic_miner_adds_cycles(self):
        """Two cycles of 500 and one of 600 MPa in each cycle of the engine."""
        signed = {"multiaxial_criterion": "signed_von_mises"}
        alone = {s: answers(loaded([s, -s], **signed))["damage"] for s in (500, 600)}
        rising = answers(loaded([600, -600, 500, -500, 500, -500], **signed))
        assert rising["damage"] == pytest.approx(alone[600] + 2 * alone[500], rel=1e-6)
        assert rising["cycles"] == pytest.approx(1 / rising["damage"])

    def test_property_rules_below_the_limit(self):
        force = [400, -400, 250, -250]
        lives = {
            rule: answers(loaded(force, miner_rule=rule))["damage"]
            for rule in ("original", "haibach", "elementary")
        }
        one = answers(loaded([400, -400]))["damage"]
        assert lives["original"] == pytest.approx(one, rel=1e-9)
        assert one < lives["haibach"] < lives["elementary"]
        below = {rule: answers(loaded([250, -250], miner_rule=rule))["life"] for rule in lives}
        assert below == {"original": "endless", "haibach": "endless", "elementary": "finite"}

    @pytest.mark.parametrize("criterion", ["findley", "signed_von_mises"])
    def test_property_loads_times_the_safety_factor_are_at_the_limit(self, criterion):
        force = cycle(150, 80)
        n = answers(loaded(force, multiaxial_criterion=criterion))["safety_factor"]
        for factor, life in ((n * (1 - 1e-6), "endless"), (n * (1 + 1e-6), "finite")):
            assert answers(loaded(factor * force, multiaxial_criterion=criterion))["life"] == life

    @pytest.mark.parametrize("criterion", ["findley", "signed_von_mises"])
    def test_property_more_load_never_means_more_life(self, criterion):
        rng = np.random.default_rng(3)
        for _ in range(5):
            force = rng.normal(size=24)
            damage = [
                answers(loaded(size * force / np.abs(force).max(), multiaxial_criterion=criterion))["damage"]
                for size in (200, 400, 500, 600)
            ]
            assert damage == sorted(damage)
            assert damage[-1] > 0

    def test_property_the_governing_point(self):
        rows = [[0, 0, s, 0, 0, 0] for s in (0.5, 1.0, 0.7)]
        for size in (200, 600):
            result = answers(loaded(cycle(size), rows))
            assert result["governing_point"] == 2
            assert result["damage"] == result["damage_of_points"].max()
        assert result["points"].tolist() == [1, 2, 3]

    def test_property_hours(self):
        result = answers(loaded(cycle(500), cycle_time="0.04 s"))
        assert result["life_in_hours"] == pytest.approx(result["cycles"] * 0.04 / 3600)

    def test_property_no_stress_is_endless(self):
        result = answers(loaded(cycle(0)))
        assert (result["life"], result["damage"], result["safety_factor"]) == ("endless", 0, None)


class TestSuperposition:
    def test_analytic_tensors_add(self):
        """Two loads, or one table that holds their sum: the same; equivalent stresses would not add."""
        force, moment = cycle(200, 50), 100 * np.sin(ANGLES)
        both = loaded(force, moment_1={"value": (1e3 * moment).tolist(), "unit": "N*m"},
                      stress_of_moment_1={"value": [SHEAR], "unit": "MPa/(kN*m)"})  # fmt: skip
        tensors = history_of([(2, 1e6 * force), (4, 1e6 * moment)])
        template = FatigueLife.from_quantities(both)
        assert template.history == pytest.approx(tensors, rel=1e-12, abs=1e-3)
        assert answers(both)["greatest_von_mises"][0] == pytest.approx(
            np.sqrt(force**2 + 3 * moment**2).max(), rel=1e-12
        )

    def test_property_linear_in_the_loads(self):
        one, twice = (FatigueLife.from_quantities(loaded(n * cycle(70, 10))).history for n in (1, 2))
        assert twice == pytest.approx(2 * one, rel=1e-14)

    def test_property_a_constant_load_is_a_mean(self):
        with_mean = answers(loaded(cycle(300, 100)))
        raw = loaded(cycle(300), moment_1="100 N*m",
                     stress_of_moment_1={"value": [TENSION], "unit": "MPa/(N*m)"})  # fmt: skip
        assert answers(raw)["cycles"] == pytest.approx(with_mean["cycles"], rel=1e-6)

    def test_property_where_the_cycle_begins_does_not_matter(self):
        rng = np.random.default_rng(4)
        force = 400 * rng.uniform(-1, 1, 36)
        lives = [answers(loaded(np.roll(force, n)))["damage"] for n in (0, 7, 20)]
        assert lives == pytest.approx([lives[0]] * 3, rel=1e-9)

    def test_property_curves_of_two_speeds_are_two_points(self):
        forces = np.stack([cycle(400), cycle(500)])
        assert answers(loaded(forces))["damage"] == pytest.approx(
            [answers(loaded(force))["damage"] for force in forces], rel=1e-9
        )


class TestCompression:
    @pytest.mark.parametrize("correction", ["goodman", "gerber", "morrow", "none"])
    def test_property_a_compressive_mean_is_zero(self, correction):
        raw = {"multiaxial_criterion": "signed_von_mises", "mean_stress_correction": correction}
        pressed, without = (answers(loaded(cycle(400, mean), **raw))["damage"] for mean in (-150, 0))
        assert pressed == pytest.approx(without, rel=1e-9)

    @pytest.mark.parametrize("criterion", ["findley", "signed_von_mises"])
    def test_property_with_credit_it_lengthens_life(self, criterion):
        raw = {"multiaxial_criterion": criterion, "compression_credit": "yes", "yield_strength": "700 MPa"}
        damage = [answers(loaded(cycle(400, mean), **raw))["damage"] for mean in (-150, 0, 100)]
        assert damage == sorted(damage)
        assert damage[0] < damage[1]

    def test_property_credit_ends_at_the_yield_strength(self):
        raw = {"multiaxial_criterion": "signed_von_mises", "compression_credit": "yes"}
        assert "yield_strength" in refused(loaded(cycle(400, -150), **raw))
        assert answers(loaded(cycle(400, -150), **raw, yield_strength="551 MPa"))["damage"] > 0
        assert "compression_used" in refused(loaded(cycle(400, -150), **raw, yield_strength="549 MPa"))

    def test_property_gerber_has_no_credit(self):
        raw = {"compression_credit": "yes", "yield_strength": "900 MPa", "mean_stress_correction": "gerber"}
        assert "mean_stress_correction" in refused(loaded(cycle(400), **raw))


class TestRefusals:
    @pytest.mark.parametrize(
        ("changes", "name"),
        [
            ({"force_2": "1 kN"}, "stress_of_force_2"),
            ({"force_2": {"value": [1, 2], "unit": "kN"}}, "force_2"),
            ({"stress_of_moment_3": {"value": [TENSION], "unit": "MPa/(kN*m)"}}, "moment_3"),
            ({"force_1": "3 kN"}, "force_1"),
            ({"force_2": "1 kN", "stress_of_force_2": {"value": [TENSION] * 2, "unit": "MPa/kN"}},
             "stress_of_force_2"),
            ({"stress_of_force_1": {"value": [[1, 2, 3]], "unit": "MPa/kN"}}, "stress_of_force_1"),
            ({"stress_of_force_1": {"value": [TENSION], "unit": "MPa"}}, "stress_of_force_1"),
            ({"endurance_limit": "800 MPa"}, "endurance_limit"),
            ({"stress_concentration_factor": 2}, "notch_radius"),
            ({"force_1": {"value": [1e5, -1e5], "unit": "kN"}}, "damage_of_points"),
        ],
    )  # fmt: skip
    def test_property_bad_input_is_named(self, changes, name):
        assert name in refused({**loaded(cycle(300)), **changes})

    def test_property_a_refusal_shows_the_first_row_of_a_long_table(self):
        raw = {**loaded(cycle(300)), "force_2": "1 kN"}
        raw["stress_of_force_2"] = {"value": [TENSION] * 150, "unit": "MPa/kN"}
        with pytest.raises(InvalidInputs, match=r"stress_of_force_2 = 150 rows from \[") as refusal:
            evaluate(FatigueLife, raw)
        assert all(len(fault.detail) < 500 for fault in refusal.value.faults)

    def test_property_too_much_at_once_is_refused(self):
        rows = [TENSION] * 200
        assert "force_1" in refused(loaded(np.zeros((30, 72)), rows))
        assert refused(loaded(np.zeros((30, 72)), rows, multiaxial_criterion="signed_von_mises"))

    @pytest.mark.slow
    def test_property_as_much_as_may_be_is_calculated(self):
        rows = [TENSION] * 200
        assert answers(loaded(np.zeros((13, 72)), rows))["life"].tolist() == ["endless"] * 13

    def test_property_no_load_at_all(self):
        assert "stress_of_force_1" in refused(STEEL)

    def test_property_signed_von_mises_needs_one_tensor(self):
        raw = loaded(cycle(300), moment_1={"value": (170 * np.sin(ANGLES)).tolist(), "unit": "kN*m"},
                     stress_of_moment_1={"value": [SHEAR], "unit": "MPa/(kN*m)"},
                     multiaxial_criterion="signed_von_mises")  # fmt: skip
        assert "multiaxial_criterion" in refused(raw)
        assert answers({**raw, "multiaxial_criterion": "findley"})["damage"] > 0

    def test_property_few_cycles_are_warned_of(self):
        (warning,) = evaluate(FatigueLife, loaded(cycle(800))).warnings
        assert warning.name == "cycles"

    def test_property_anything_is_a_number_or_refused_by_name(self):
        rng = np.random.default_rng(11)
        kept, details = 0, []
        for _ in range(40):
            size = 10 ** rng.uniform(-3, 4)
            rows = (rng.normal(size=(3, 6)) * rng.choice([0, 1, 1], (3, 1))).tolist()
            raw = loaded(size * rng.normal(size=rng.integers(2, 30)), rows)
            raw |= {
                "multiaxial_criterion": str(rng.choice(["findley", "signed_von_mises"])),
                "mean_stress_correction": str(rng.choice(["goodman", "gerber", "morrow", "none"])),
                "miner_rule": str(rng.choice(["haibach", "original", "elementary"])),
                "compression_credit": str(rng.choice(["no", "yes"])),
                "yield_strength": "600 MPa",
            }
            try:
                result = evaluate(FatigueLife, raw)
            except InvalidInputs as refusal:
                details += [fault.detail for fault in refusal.faults]
                continue
            kept += 1
            for name, answer in result.outputs.items():
                if isinstance(answer.value, str) or answer.value is None:
                    assert answer.value or answer.reason, name
                else:
                    assert np.isfinite(answer.value).all(), name
        assert kept > 10
        assert all(details)


def test_property_counts_of_many_points_are_those_of_each():
    rng = np.random.default_rng(6)
    histories = rng.normal(size=(5, 40))
    together = by_rainflow(histories)
    for row in range(5):
        alone = by_rainflow(histories[row])
        used = together.count[row] > 0
        assert together.amplitude[row][used].tolist() == alone.amplitude[alone.count > 0].tolist()
    assert together.amplitude.max(axis=-1) == pytest.approx(np.ptp(histories, axis=1) / 2)
