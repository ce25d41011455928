"""`solve` finds every root within the bounds: analytic curves, random polynomials, levels, bounded work."""

import numpy as np
import pytest

from templates.core.errors import InvalidInputs, Unreachable
from templates.core.language import levels, scan
from templates.core.language.confirmation import CONFIRMED
from templates.core.language.crossings import MOST_ROOTS
from templates.core.language.evaluate import evaluate
from templates.core.language.levels import Accuracy
from templates.core.language.scan import SAMPLES
from templates.core.language.solve import solve
from templates.core.language.template import Template, curve, formula, given, profile, shared
from templates.oil_film.oil_film_v1 import OilFilm as Paper
from templates.oil_film.oil_film_v2 import OilFilm


class Shapes(Template):
    """Curves with known solutions."""

    example = {"x": "1 m"}

    x = given("m", "x")
    a, b, c, d = (given("m", f"zero {name}", default="0 m") for name in "abcd")

    @formula("1", "quartic")
    def quartic(self):
        return (self.x - self.a) * (self.x - self.b) * (self.x - self.c) * (self.x - self.d)

    @formula("1", "saw")
    def saw(self):
        return self.x - np.floor(self.x)

    @formula("1", "wave")
    def wave(self):
        return np.sin(self.x)

    @formula("1", "holey", ge=0.25, remedy="keep out of the hole")
    def holey(self):
        return self.x**2

    @formula("1", "flat")
    def flat(self):
        return self.a * 0 + 1


def solved(output, target, low="-10 m", high="10 m", **raw):
    return solve(Shapes, raw, "x", [low, high], {output: target}, outputs=[output])


def zeros(values):
    return {f"zero_{name}": f"{value!r} m" for name, value in zip("abcd", values, strict=True)}


def found(result):
    return [root.value for root in result.roots]


@pytest.mark.parametrize(("low", "bound"), [("2 m", "2 m"), ("1.999 m", None)])
def test_a_solution_on_a_bound_of_the_search_is_called_that(low, bound):
    """x (x - 2)^3 is 0 at 2 m, which is the lower bound or lies inside."""
    result = solved("quartic", 0, low, "5 m", **zeros([0.0, 2.0, 2.0, 2.0]))
    said = [warning.detail for warning in result.warnings if warning.code == "at_bound"]
    assert said == ([f"{bound} lies on a bound of the search; there may be more beyond"] if bound else [])


class TestRoots:
    def test_analytic_all_with_the_signs_of_their_slopes(self):
        result = solved("quartic", 0, **zeros([-7.0, -1.5, 0.25, 6.0]))
        assert found(result) == pytest.approx([-7, -1.5, 0.25, 6], abs=1e-12)
        assert [root.crossing for root in result.roots] == ["falls", "rises", "falls", "rises"]
        assert result.unknown == result.roots[0].value
        (warning,) = [w for w in result.warnings if w.code == "several_solutions"]
        assert "-1.5 m, 0.25 m, 6 m give the target too" in warning.detail
        assert (result.touching, result.jumps) == ([], [])

    @pytest.mark.parametrize("seed", range(30))
    def test_property_random_zeros(self, seed):
        """Also pairs that lie far closer together than the samples of the scan."""
        rng = np.random.default_rng(seed)
        pair = rng.uniform(-9, 9, 2)
        apart = 10.0 ** rng.uniform(-4, 0)
        places = sorted([pair[0], pair[0] + apart, pair[1], pair[1] + 0.7])
        result = solved("quartic", 0, **zeros([float(p) for p in places]))
        assert found(result) == pytest.approx(places, abs=1e-8)

    def test_analytic_a_target_that_is_only_touched(self):
        result = solved("quartic", 0, **zeros([1.0, 1.0, 2.0, 2.0]))
        assert [root.value for root in result.touching] == pytest.approx([1, 2], abs=1e-6)
        assert result.roots == []
        assert result.unknown == result.touching[0].value
        assert {root.crossing for root in result.touching} == {"touches"}
        assert {(root.slope, root.no_slope) for root in result.touching} == {
            (None, "the output touches the target without crossing it")
        }

    @pytest.mark.parametrize(("target", "count"), [(0.999_999, 2), (1.000_001, 0)])
    def test_analytic_a_hair_below_and_above_the_top(self, target, count):
        if count:
            assert len(found(solved("wave", target, "0 m", "3 m"))) == count
        else:
            with pytest.raises(Unreachable, match="out of reach"):
                solved("wave", target, "0 m", "3 m")

    def test_analytic_a_value_at_all_samples_is_one_solution(self):
        result = solved("flat", 1)
        (root,) = result.roots
        assert (root.value, root.crossing) == (-10.0, "touches")
        assert (root.slope, root.no_slope) == (None, "the output is flat here")
        assert [warning.code for warning in result.warnings] == ["at_bound"]

    def test_analytic_jumps_across_the_target(self):
        """The saw rises through 0.5 in the middle of each tooth and falls through it at each whole metre."""
        result = solved("saw", 0.5, "-1.75 m", "2.25 m")
        assert found(result) == pytest.approx([-1.5, -0.5, 0.5, 1.5], abs=1e-12)
        assert [jump.value for jump in result.jumps] == pytest.approx([-1, 0, 1, 2], abs=1e-9)
        for jump in result.jumps:
            assert (jump.before, jump.after) == (pytest.approx(1, abs=1e-6), pytest.approx(0, abs=1e-6))

    def test_analytic_solutions_on_both_sides_of_a_hole(self):
        result = solved("holey", 0.36)
        assert found(result) == pytest.approx([-0.6, 0.6], abs=1e-12)
        traced = result.curve
        hole = np.abs(traced.x) < 0.5
        assert np.isnan(traced.y).tolist() == hole.tolist()
        assert all("≥ 0.25" in reason for reason in traced.reasons[hole])
        assert set(traced.reasons[~hole]) == {None}

    def test_analytic_a_solution_just_inside_the_hole_is_none(self):
        with pytest.raises(Unreachable) as error:
            solved("holey", 0.2)
        assert error.value.reachable[0] == pytest.approx(0.25, rel=1e-6)

    def test_property_the_work_is_bounded(self):
        """Sixteen hundred waves: some of the crossings are closed in, and it says that there are more."""
        result = solved("wave", 0.5, "0 m", "10000 m")
        assert len(result.roots) == MOST_ROOTS
        assert all(np.sin(root.value) == pytest.approx(0.5, abs=1e-6) for root in result.roots)
        (warning,) = [w for w in result.warnings if w.code == "several_solutions"]
        assert " more give the target too" in warning.detail


class TestCurve:
    def test_property_even_samples(self):
        result = solved("quartic", 0, **zeros([-7.0, -1.5, 0.25, 6.0]))
        assert result.curve.x == pytest.approx(np.linspace(-10, 10, SAMPLES))
        expected = evaluate(Shapes, {"x": {"value": result.curve.x.tolist(), "unit": "m"},
                                     **zeros([-7.0, -1.5, 0.25, 6.0])}, outputs=["quartic"])  # fmt: skip
        assert result.curve.y == pytest.approx(expected.outputs["quartic"].value, rel=1e-12)

    def test_property_even_in_the_logarithm_over_a_decade(self):
        wide = solved("holey", 4.0, "1 m", "100 m").curve.x
        assert np.diff(np.log(wide)) == pytest.approx(np.log(100) / (SAMPLES - 1))
        narrow = solved("holey", 4.0, "1 m", "9 m").curve.x
        assert np.diff(narrow) == pytest.approx(8 / (SAMPLES - 1))


class TestFilm:
    @pytest.mark.parametrize(
        ("cls", "load", "film"), [(Paper, "25 kN", 3.2449), (OilFilm, "25 kN", 2.9), (OilFilm, "12 kN", 4.3)]
    )
    def test_literature_one_film_has_two_clearances(self, cls, load, film):
        """Too tight a bearing starves its film as too wide a one does; both, against a dense sweep."""
        raw = {**cls.example, "radial_load": load}
        del raw["diametral_clearance"]
        thickness = "minimum_film_thickness"
        result = solve(cls, raw, "diametral_clearance", ["2 um", "0.5 mm"], {thickness: f"{film} um"})
        dense = np.geomspace(2e-3, 0.5, 20_001)
        swept = evaluate(
            cls, {**raw, "diametral_clearance": {"value": dense.tolist(), "unit": "mm"}}, outputs=[thickness]
        )
        above = swept.outputs[thickness].value > film
        (crossed,) = (dense[np.flatnonzero(np.diff(above.astype(int)))],)
        assert len(found(result)) == len(crossed) == 2
        assert found(result) == pytest.approx(crossed, rel=5e-4)
        assert [root.crossing for root in result.roots] == ["rises", "falls"]
        for root in result.roots:
            assert 0 < root.error < 0.3
            again = evaluate(cls, {**raw, "diametral_clearance": f"{root.value!r} mm"}, outputs=[thickness])
            assert again.outputs[thickness].value == pytest.approx(film, rel=1e-9)

    def test_property_roots_at_an_expensive_level(self):
        raw = {name: value for name, value in OilFilm.example.items() if name != "diametral_clearance"}
        question = ("diametral_clearance", ["2 um", "0.5 mm"], {"minimum_film_thickness": "2.9 um"})
        names = ["minimum_film_thickness"]
        cheap, fine = (solve(OilFilm, raw, *question, level=n, outputs=names) for n in ("map", "reynolds"))
        assert found(fine) == pytest.approx(found(cheap), rel=1e-4)
        assert found(fine) != found(cheap)
        assert fine.curve.level == "map"
        assert {(root.level, root.confirmed) for root in fine.roots} == {("reynolds", True)}


class Rungs(Template):
    """A cheap level that is 10 % off and an expensive one for few points, which ends at 8 m."""

    levels = ("cheap", "fine")
    default_level = "cheap"
    most_points = {"fine": 1}
    example = {"x": "1 m"}
    calls, off = 0, 1.1

    x = given("m", "x")

    @shared
    def share(self):
        """What the level makes of it."""
        if self.level == "fine":
            Rungs.calls += 1
        return {"cheap": Rungs.off, "fine": 1.0}[self.level]

    @formula("1", "height")
    def height(self):
        return np.sin(self.x * self.share) + self.ends

    @shared
    def ends(self):
        """NaN where the expensive level ends."""
        return np.where((self.level == "fine") & (self.x > 8), np.nan, 0.0)[()]


class TestLevels:
    def solved(self, low, high, target=0.5, **options):
        Rungs.calls = 0
        return solve(Rungs, {}, "x", [low, high], {"height": target}, outputs=["height"], **options)

    def test_property_confirmed_at_the_level_requested(self):
        result = self.solved("0 m", "3 m", level="fine")
        assert found(result) == pytest.approx([np.pi / 6, np.pi * 5 / 6], rel=1e-8)
        assert {root.level for root in result.roots} == {"fine"}
        assert result.curve.level == "cheap"

    def test_property_a_level_of_few_points_is_drawn_about_its_solutions(self):
        """A sample of the scan to both sides of each solution, with the height at level fine."""
        result = self.solved("0 m", "3 m", level="fine")
        [finer] = result.finer
        assert (finer.level, finer.x.size) == ("fine", 6)
        assert finer.y == pytest.approx(np.sin(finer.x), rel=1e-12)
        for root in result.roots:
            place = int(np.flatnonzero(finer.x == root.value)[0])
            assert finer.x[place - 1] < root.value < finer.x[place + 1]
            assert finer.y[place] == root.output

    def test_property_a_level_of_many_points_is_drawn_whole(self, monkeypatch):
        monkeypatch.setattr(Rungs, "most_points", {"fine": SAMPLES})
        result = self.solved("0 m", "3 m", level="fine")
        [finer] = result.finer
        assert set(result.curve.x) <= set(finer.x)
        assert np.interp(found(result), finer.x, finer.y) == pytest.approx([0.5, 0.5], rel=1e-8)
        assert np.interp(found(result), result.curve.x, result.curve.y) != pytest.approx([0.5, 0.5], rel=1e-2)

    def test_property_what_the_level_refuses_beside_a_solution_says_why(self):
        """Level fine ends at 8 m; its solution lies at 6.81 m, the sample above it at 8.2 m."""
        [finer] = self.solved("6 m", "36 m", level="fine").finer
        below, solution, above = zip(finer.y, finer.reasons, strict=True)
        assert (below[1], solution[1]) == (None, None)
        assert solution[0] == pytest.approx(0.5, rel=1e-8)
        assert np.isnan(above[0])
        assert above[1]

    def test_property_one_level_has_one_curve(self):
        assert self.solved("0 m", "3 m", level="cheap").finer == []

    def test_property_an_expensive_level_is_asked_a_few_times(self):
        result = self.solved("0 m", "7.5 m", level="fine")
        assert len(result.roots) == 3
        assert Rungs.calls <= 3 * (9 + 2) + 1

    def test_property_most_roots_stay_at_the_level_of_the_scan(self, monkeypatch):
        """Of many solutions the first are calculated again; the others say that they were not."""
        monkeypatch.setattr(Rungs, "off", 1.0001)
        many = self.solved("-99 m", "7.9 m", level="fine").roots
        assert [root.confirmed for root in many] == [n < CONFIRMED for n in range(len(many))]
        assert {root.level for root in many[CONFIRMED:]} == {"cheap"}

    def test_property_two_that_move_to_the_same_are_one(self):
        """A hundred metres away the levels are waves apart: what is returned is true, and ascends."""
        roots = [root for root in self.solved("-100 m", "7.9 m", level="fine").roots if root.confirmed]
        assert [np.sin(root.value) for root in roots] == pytest.approx([0.5] * len(roots), abs=1e-6)
        assert (np.diff([root.value for root in roots]) > 1e-3).all()

    def test_property_a_root_that_the_level_refuses_is_not_returned(self):
        result = self.solved("6 m", "13 m", level="fine")
        assert [root.confirmed for root in result.roots] == [True, False, False]
        assert result.unknown == result.roots[0].value

    def test_property_no_root_at_the_level_is_a_refusal(self):
        with pytest.raises(InvalidInputs, match="no finite value"):
            self.solved("8.5 m", "13 m", level="fine")

    def test_property_a_root_beyond_the_bounds_is_none(self):
        """At level cheap 0.476 m, at level fine 0.5236 m: outside the bounds."""
        with pytest.raises(Unreachable, match="at level fine no value between the bounds is found"):
            self.solved("0.2 m", "0.5 m", level="fine")

    def test_property_a_tolerance_keeps_one_level_and_states_the_error(self, monkeypatch):
        grid, errors = np.array([0.0, 100.0]), {"cheap": 0.1, "fine": 0.001}
        tables = {level: {"height": np.full((1, 1), error)} for level, error in errors.items()}
        monkeypatch.setitem(levels._cache, Rungs, Accuracy(("x", "x"), (grid, grid), tables, {"levels": {}}))
        for tolerance, level in ((0.2, "cheap"), (0.01, "fine")):
            result = self.solved("0 m", "3 m", tolerance=tolerance)
            assert {(root.level, root.error) for root in result.roots} == {(level, errors[level])}
            assert result.evaluation.outputs["height"].value == pytest.approx(0.5, rel=1e-8)


class Cycle(Template):
    """A height under a long curve."""

    example = {"x": "1 m", "angle": {"value": [0, 1], "unit": "deg"}}

    x = given("m", "x")
    angle = curve("deg", "angle")

    @formula("1", "height")
    def height(self):
        return self.x + self.angle.mean(axis=-1) * 0

    @profile("1", "path", along="path")
    def path(self):
        return self.x[..., None] + self.angle


def test_property_long_curves_are_scanned_in_parts(monkeypatch):
    """So that samples times points of a curve stay a bounded amount of memory."""
    sizes = []
    kept = scan.TargetCurve.evaluation

    def counting(self, values):
        sizes.append(np.size(values))
        return kept(self, values)

    monkeypatch.setattr(scan.TargetCurve, "evaluation", counting)
    long = {"value": np.linspace(0, 700, 3600).tolist(), "unit": "deg"}
    result = solve(Cycle, {"angle": long}, "x", ["0 m", "3 m"], {"height": 2}, outputs=["height"])
    assert found(result) == pytest.approx([2])
    assert max(sizes) <= scan.CELLS // 3600
    assert result.curve.x.size == SAMPLES
