"""References of errors, and which levels are closer to the same reference."""

from pathlib import Path

import numpy as np
import pytest

from templates.core.criteria.bands import CONVENTION
from templates.core.language import levels
from templates.core.language.evaluate import evaluate
from templates.core.language.level_choice import reachable
from templates.core.language.levels import Accuracy, accuracy, next_levels
from templates.core.language.spec import Text
from templates.core.language.template import Template, formula, given, profile, shared
from templates.door import built_in
from templates.oil_film.elastic_film_v1 import ElasticFilm
from templates.oil_film.oil_film_v2 import OilFilm

ROOT = Path(__file__).parents[3]
MEASURED = [cls for cls in built_in() if accuracy(cls)]


class Rungs(Template):
    """Three levels, of which the last follows another convention of drag."""

    levels = ("rough", "fine", "other")
    default_level = "fine"
    example = {"length": "2 m", "height": "1 m"}

    x = given("m", "length")
    y = given("m", "height", default="1 m")
    hot = given("K", "heat", alternative=True)

    @shared
    def share(self):
        """What the level makes of it."""
        return {"rough": 1.1, "fine": 1.01, "other": 0.9}[self.level]

    @formula("m", "size")
    def s(self):
        return self.x * self.share

    @formula("m", "drag")
    def d(self):
        return self.s + self.y

    @formula("K", "warmth", absent="no heat is given")
    def warm(self):
        return self.hot * self.x / self.x

    @profile("m", "wave", along="wave")
    def wave(self):
        return (self.s * 0 + self.x)[..., None] * np.array([-2.0, 0.0, 1.0])


@pytest.fixture
def table(monkeypatch):
    """Errors by level, the same in the four cells but for `size` at level fine."""

    def made(conditions=()):
        flat = {"rough": (0.1, 0.2, 0.3), "fine": (0.01, 0.02, 0.03), "other": (0.001, 0.002, 0.003)}
        errors = {
            level: {
                name: np.full((2, 2), e) for name, e in zip(("size", "drag", "wave"), values, strict=True)
            }
            for level, values in flat.items()
        }
        errors["fine"]["size"] = np.array([[0.01, 0.01], [0.2, 0.2]])
        truth = {level: dict.fromkeys(("size", "drag", "wave"), "film") for level in flat}
        truth["other"]["drag"] = "film, other drag"
        content = {"levels": {level: {"truth": truth[level]} for level in flat}, "conditions": conditions}
        grid = np.array([0.0, 10.0, 100.0])
        measured = Accuracy(("x", "y"), (grid, grid), errors, content)
        monkeypatch.setitem(levels._cache, Rungs, measured)
        return measured

    return made


def rung(level, **raw):
    return Rungs.from_quantities({**Rungs.example, **raw}).at(level)


class TestTruth:
    @pytest.mark.parametrize("cls", MEASURED, ids=lambda cls: f"{cls.id}_{cls.version}")
    def test_property_every_stated_error_names_its_truth(self, cls):
        """And every name is explained in the table."""
        measured = accuracy(cls)
        for level, tables in measured.errors.items():
            for output, cells in tables.items():
                truth = measured.truth(level, output)
                assert truth or not np.isfinite(cells).any(), (level, output)
                assert truth is None or measured.content["truths"][truth]

    @pytest.mark.parametrize("cls", MEASURED, ids=lambda cls: f"{cls.id}_{cls.version}")
    def test_property_every_table_is_relative_to_the_truth(self, cls):
        """And the script that wrote it measures so."""
        content = accuracy(cls).content
        assert content["convention"] == CONVENTION
        script = ROOT / f"{content['made_by'].split()[2].replace('.', '/')}.py"
        assert "CONVENTION" in script.read_text(encoding="utf-8")

    def test_property_two_conventions_of_friction_are_two_truths(self):
        """Power loss of the example: `map` 657.9 W by shear all around, `mass_conserving` 530.7 W."""
        loss = {
            level: evaluate(OilFilm, OilFilm.example, level=level, outputs=["power_loss"])
            for level in ("map", "mass_conserving")
        }
        values = [one.outputs["power_loss"].value for one in loss.values()]
        bands = [one.error["power_loss"] for one in loss.values()]
        assert values[0] * (1 - bands[0]) > 1.2 * values[1] * (1 + bands[1])  # no band explains it
        truth = accuracy(OilFilm).truth
        truths = [truth(level, "power_loss") for level in loss]
        assert truths == ["Swift-Stieber, shear all around", "Swift-Stieber, shear where oil is"]
        assert {truth(level, "minimum_film_thickness") for level in loss} == {"Swift-Stieber"}

    def test_property_nothing_is_named_where_nothing_is_measured(self):
        assert accuracy(OilFilm).truth("map", "density") is None
        assert accuracy(OilFilm).truth("map", "no_such_output") is None


class TestNextLevels:
    def test_property_those_with_a_smaller_error(self, table):
        table()
        assert [(n.level, n.error) for n in next_levels(rung("rough"), "size")] == [
            ("fine", 0.01),
            ("other", 0.001),
        ]
        assert [n.level for n in next_levels(rung("fine"), "size")] == ["other"]
        assert next_levels(rung("other"), "size") == ()

    def test_property_within_the_same_truth(self, table):
        table()
        assert [n.level for n in next_levels(rung("rough"), "drag")] == ["fine"]
        assert next_levels(rung("fine"), "drag") == ()

    def test_property_a_level_that_is_not_better_is_left_out(self, table):
        """In the second row of cells level fine errs by 0.2, level rough by 0.1."""
        table()
        assert [n.level for n in next_levels(rung("rough", length="20 m"), "size")] == ["other"]
        points = {"value": [5, 20], "unit": "m"}
        (fine, other) = next_levels(rung("rough", length=points), "size")
        assert (fine.level, fine.error.tolist()) == ("fine", [0.01, 0.2])
        assert other.error.tolist() == [0.001, 0.001]

    def test_property_none_without_a_stated_error(self, table):
        table()
        assert next_levels(rung("rough", length="200 m"), "size") == ()
        assert next_levels(rung("rough"), "warmth") == ()
        assert next_levels(ElasticFilm.from_quantities(ElasticFilm.example), "minimum_film_thickness") == ()

    def test_property_the_film_climbs_to_the_map_and_no_farther(self):
        """`mass_conserving` follows another convention, and errs more."""
        film = OilFilm.from_quantities(OilFilm.example)
        levels = [n.level for n in next_levels(film.at("short_bearing"), "minimum_film_thickness")]
        assert levels[0] == "map"
        assert "fit" not in levels  # taken by name only
        assert "mass_conserving" not in levels
        assert "mass_conserving" not in [n.level for n in next_levels(film.at("fit"), "power_loss")]


class TestConditions:
    CONDITION = {"inputs": ["heat"], "added": {"fine": {"warmth": 0.05}, "rough": {}}}

    def test_property_what_comes_on_top(self, table):
        table([self.CONDITION])
        cold = evaluate(Rungs, Rungs.example, outputs=["size"]).error
        warm = evaluate(Rungs, {**Rungs.example, "heat": "3 K"}, outputs=["size", "warmth"]).error
        assert warm == {"size": cold["size"], "warmth": pytest.approx(0.05)}

    def test_property_unmeasured_under_a_condition_is_unknown(self, table):
        table([self.CONDITION])
        raw = {**Rungs.example, "heat": "3 K"}
        assert np.isnan(evaluate(Rungs, raw, outputs=["warmth"], level="rough").error["warmth"])
        assert evaluate(Rungs, raw, outputs=["size"], level="rough").error["size"] == 0.1


class TestReachable:
    def test_property_nothing_beyond_a_default_level_without_errors(self):
        assert reachable(ElasticFilm, ElasticFilm.levels) == ("rigid",)
        assert reachable(OilFilm, OilFilm.levels) == OilFilm.levels
        assert reachable(OilFilm, ("mass_conserving",)) == ("mass_conserving",)


def test_property_texts_have_no_truth():
    texts = {cls: [n for n, f in cls.formulas.items() if isinstance(f, Text)] for cls in MEASURED}
    assert any(texts.values())
    for cls, names in texts.items():
        assert {accuracy(cls).truth(level, name) for level in accuracy(cls).errors for name in names} <= {
            None
        }
