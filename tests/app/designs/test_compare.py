"""The comparison of two revisions or designs lists the differences with amount and unit."""

from copy import deepcopy

import pytest
from serving import API, created, faults, moody, paper, patched, problem

from app.designs.differences import MOST_SHOWN, differing

DESIGNS = f"{API}/designs"


def compared(http, id, **query):
    answer = http.get(f"{DESIGNS}/{id}/compare", params=query)
    assert answer.status_code == 200, answer.text
    return answer.json()


def by_name(items):
    return {item["name"]: item for item in items}


@pytest.fixture(scope="module")
def design(http):
    """Three revisions: scale 1, then 1.05, then 1 with another speed."""
    first = created(http, paper(name="compared"))
    first = patched(http, first, {"parameters": {"scale": "1.05"}})
    speed = {"steps": {"film": {"inputs": {"speed": "6000 rpm"}}}}
    return patched(http, first, {"parameters": {"scale": "1"}, **speed, "note": "faster"})


class TestRevisions:
    def test_any_two_are_compared(self, http, design):
        comparison = compared(http, design["id"], revision=1, **{"with": 3})
        assert (comparison["old"]["revision"], comparison["new"]["revision"]) == (1, 3)
        assert (comparison["new"]["note"], comparison["new"]["design"]) == ("faster", design["id"])
        (speed,) = comparison["inputs"]
        assert (speed["name"], speed["old"], speed["new"]) == (
            "film.speed",
            {"value": 5000, "unit": "rpm"},
            {"value": 6000, "unit": "rpm"},
        )
        assert speed["change"] == pytest.approx(0.2)
        assert speed["difference"] == {"value": pytest.approx(1000), "unit": "rpm"}
        outputs = by_name(comparison["outputs"])
        film = outputs["film.minimum_film_thickness"]
        assert film["old"]["unit"] == film["new"]["unit"] == "um"
        change = film["new"]["value"] / film["old"]["value"] - 1
        assert film["change"] == pytest.approx(change)
        assert "film.journal_diameter" not in outputs, "it is the same"
        assert comparison["parameters"] == comparison["relations"] == comparison["model_parameters"] == []
        assert comparison["measurements"] == []

    def test_a_size_that_changed_changed_the_solid(self, http, design):
        comparison = compared(http, design["id"], revision=1, **{"with": 2})
        assert comparison["parameters"] == [{"name": "scale", "old": "1", "new": "1.05"}]
        bore = by_name(comparison["model_parameters"])["model.inner_diameter"]
        assert (bore["old"]["value"], bore["new"]["value"]) == (48, pytest.approx(50.4))
        measured = by_name(comparison["measurements"])
        assert measured["model.mass"]["change"] > 0.05
        assert measured["model.dimensions.inner_diameter"]["new"]["value"] == pytest.approx(50.4)
        assert measured["model.bounding_box.high"]["old"]["unit"] == "mm"

    def test_the_newest_is_compared_with_the_one_before(self, http, design):
        comparison = compared(http, design["id"])
        assert (comparison["old"]["revision"], comparison["new"]["revision"]) == (2, 3)
        comparison = compared(http, design["id"], revision=1)
        assert (comparison["old"]["revision"], comparison["new"]["revision"]) == (1, 3)
        comparison = compared(http, design["id"], **{"with": 2})
        assert (comparison["old"]["revision"], comparison["new"]["revision"]) == (1, 2)

    def test_backwards_is_the_opposite(self, http, design):
        (speed,) = compared(http, design["id"], revision=3, **{"with": 1})["inputs"]
        assert speed["change"] == pytest.approx(-1 / 6)

    def test_a_revision_equals_itself(self, http, design):
        comparison = compared(http, design["id"], revision=2, **{"with": 2})
        assert all(part == [] for name, part in comparison.items() if name not in ("old", "new", "table"))
        assert [row["name"] for row in comparison["table"]["rows"]] == ["revision 2"]

    def test_units_of_display(self, http, design):
        comparison = compared(http, design["id"], revision=1, **{"with": 2, "units": "us"})
        bore = by_name(comparison["model_parameters"])["model.inner_diameter"]
        assert bore["old"] == {"value": pytest.approx(48 / 25.4), "unit": "inch"}
        assert bore["difference"] == {"value": pytest.approx(2.4 / 25.4), "unit": "inch"}
        assert bore["change"] == pytest.approx(0.05)

    @pytest.mark.parametrize(
        ("query", "status", "slug"),
        [
            ({"revision": 9}, 404, "not-found"),
            ({"with": 9}, 404, "not-found"),
            ({"design": "none"}, 404, "not-found"),
            ({"revision": 0}, 422, "invalid-inputs"),
            ({"with": "newest"}, 422, "invalid-inputs"),
            ({"design": "a" * 65}, 422, "invalid-inputs"),
        ],
    )
    def test_what_is_not_there_is_said(self, http, design, query, status, slug):
        problem(http.get(f"{DESIGNS}/{design['id']}/compare", params=query), status, slug)
        problem(http.get(f"{DESIGNS}/none/compare"), 404, "not-found")


class TestTable:
    """The main results of both revisions, with the change of the newer one."""

    def values(self, table, row):
        (row,) = (one for one in table["rows"] if one["name"] == row)
        return dict(zip([one["name"] for one in table["columns"]], row["values"], strict=True))

    def test_results_of_both_revisions_with_their_change(self, http, design):
        comparison = compared(http, design["id"], revision=1, **{"with": 3})
        table = comparison["table"]
        names = [column["name"] for column in table["columns"]]
        assert names == [
            "film.radial_load", "film.speed", "film.relative_eccentricity", "film.minimum_film_thickness"
        ], "the model is the same, so that its mass is left out"  # fmt: skip
        film = by_name(comparison["outputs"])["film.minimum_film_thickness"]
        assert self.values(table, "revision 1")[names[-1]] == film["old"]["value"]
        assert self.values(table, "revision 3")[names[-1]] == film["new"]["value"]
        assert table["rows"][1]["changes"] == pytest.approx([0, 0.2, *table["rows"][1]["changes"][2:]])
        assert table["rows"][1]["changes"][-1] == pytest.approx(film["change"])
        assert "changes" not in table["rows"][0]

    def test_measures_of_solids_are_columns(self, http, design):
        comparison = compared(http, design["id"], revision=1, **{"with": 2})
        mass = by_name(comparison["measurements"])["model.mass"]
        table = comparison["table"]
        assert self.values(table, "revision 1")["model.mass"] == pytest.approx(mass["old"]["value"])
        assert self.values(table, "revision 2")["model.mass"] == pytest.approx(mass["new"]["value"])
        us = compared(http, design["id"], revision=1, **{"with": 2, "units": "us"})["table"]
        assert self.values(us, "revision 1")["model.mass"] == pytest.approx(mass["old"]["value"] / 0.45359237)
        assert {"name": "model.mass", "words": "mass of model", "unit": "lb"} in us["columns"]

    def test_the_governing_row_of_both_is_marked(self, http):
        limit = {"criteria": {"thick": {"require": "film.minimum_film_thickness >= 3 um"}}}
        document = {**paper(name="judged twice"), **limit}
        del document["model"]
        document["steps"]["film"]["inputs"]["bearing_diameter"] = "48 mm"
        first = created(http, document)
        slow = {"steps": {"film": {"inputs": {"speed": "2500 rpm"}}}}
        table = compared(http, patched(http, first, slow)["id"])["table"]
        assert [row.get("governs", False) for row in table["rows"]] == [False, True]
        assert table["governing"].startswith("revision 2 governs; ")
        again = {"steps": {"film": {"inputs": {"speed": "2499 rpm"}}}}
        design = patched(http, http.get(f"{DESIGNS}/{first['id']}").json(), again)
        table = compared(http, design["id"])["table"]
        assert [row["governs"] for row in table["rows"]] == [True, True]
        assert table["governing"].startswith("revision 2, revision 3 govern (2 equal within 0.5 %)")

    def test_rows_of_variants_stand_below_each_other(self, http):
        document = paper(name="two widths")
        document["variants"] = {"wide": {"scale": "1.05"}, "old": {"scale": "1.02"}}
        first = created(http, document)
        design = patched(http, first, {"variants": {"old": None, "new": {"scale": "1.03"}}})
        table = compared(http, design["id"])["table"]
        assert [row["name"] for row in table["rows"]] == [
            "revision 1: design itself", "revision 2: design itself", "revision 2: new",
            "revision 1: wide", "revision 2: wide", "revision 1: old",
        ]  # fmt: skip
        changed = [row["name"] for row in table["rows"] if "changes" in row]
        assert changed == ["revision 2: design itself", "revision 2: wide"]

    def test_a_column_has_the_unit_of_the_newer_revision(self, http):
        document = moody("10 mm", parameters={"gap": "2 mm"}, table={"columns": ["gap"]})
        design = patched(http, created(http, document), {"parameters": {"gap": "1 inch"}})
        table = compared(http, design["id"])["table"]
        assert [column["unit"] for column in table["columns"]] == ["inch"]
        assert [row["values"] for row in table["rows"]] == [[pytest.approx(2 / 25.4)], [1]]
        design = patched(http, design, {"parameters": {"gap": "1 kg"}})
        table = compared(http, design["id"])["table"]
        assert [row["values"] for row in table["rows"]] == [[None], [1]]
        assert table["rows"][0]["reasons"] == {"gap": "its unit inch does not fit the column"}


class TestDesigns:
    def test_two_designs(self, http, design):
        document = deepcopy(paper(name="other"))
        document["steps"]["film"]["version"] = 2
        document["steps"]["film"]["inputs"]["bearing_diameter"] = "48 mm"
        other = created(http, document)
        comparison = compared(http, design["id"], revision=1, design=other["id"])
        assert (comparison["old"]["name"], comparison["new"]["name"]) == ("compared", "other")
        assert (comparison["old"]["revision"], comparison["new"]["revision"]) == (1, 1)
        assert {change["name"] for change in comparison["versions"]} == {"film", "film.level"}
        versions = by_name(comparison["versions"])["film"]
        assert versions["old"].startswith("oil_film version 1, code ")
        assert versions["new"].startswith("oil_film version 2, code ")
        assert comparison["relations"] == [
            {"name": "film.bearing_diameter", "old": "= scale * 48 mm", "new": None}
        ]
        outputs = by_name(comparison["outputs"])
        assert outputs["film.attitude_angle"]["old"] is None
        assert "change" not in outputs["film.attitude_angle"]

    def test_a_design_of_other_steps(self, http, design):
        other = created(http, moody("10 mm"))
        comparison = compared(http, design["id"], design=other["id"])
        assert all(item["new"] is None for item in comparison["inputs"])
        assert by_name(comparison["model_parameters"])["model.size"]["old"] is None
        assert comparison["old"]["revision"] == 3


class TestValues:
    def differ(self, old, new):
        return [item.plain() for item in differing({"x": old}, {"x": new})]

    def test_the_same_in_another_unit_is_no_difference(self):
        assert self.differ({"value": 25, "unit": "kN"}, {"value": 25000.0, "unit": "N"}) == []
        assert self.differ({"value": 80, "unit": "degC"}, {"value": 353.15, "unit": "K"}) == []
        assert self.differ({"value": [1, 2], "unit": "mm"}, {"value": [1e3, 2e3], "unit": "um"}) == []

    def test_other_kinds_are_a_difference_without_a_change(self):
        (item,) = self.differ({"value": 1, "unit": "mm"}, {"value": 1, "unit": "kg"})
        assert item.keys() == {"name", "old", "new"}
        (item,) = self.differ({"value": "half"}, {"value": "full"})
        assert (item["old"], item["new"]) == ({"value": "half"}, {"value": "full"})

    def test_a_temperature_has_a_difference_in_kelvin_and_no_relative_change(self):
        (item,) = self.differ({"value": 80, "unit": "degC"}, {"value": 90, "unit": "degC"})
        assert item["difference"] == {"value": pytest.approx(10), "unit": "delta_degC"}
        assert "change" not in item

    def test_from_zero_there_is_no_relative_change(self):
        (item,) = self.differ({"value": 0, "unit": "mm"}, {"value": 2, "unit": "mm"})
        assert item["difference"] == {"value": 2, "unit": "mm"}
        assert "change" not in item

    def test_what_has_no_value_says_why(self):
        (item,) = self.differ({"value": None, "unit": "mm", "reason": "no load"}, {"value": 2, "unit": "mm"})
        assert item["old"] == {"value": None, "unit": "mm", "reason": "no load"}
        assert "change" not in item

    def test_a_long_array_is_shown_by_its_range(self):
        old = [float(n) for n in range(MOST_SHOWN + 1)]
        new = [*old[:5], None, *old[6:-1], 40.0]
        (item,) = self.differ({"value": old, "unit": "mm"}, {"value": new, "unit": "mm"})
        assert item["old"] == {"unit": "mm", "count": 21, "least": 0, "largest": 20}
        assert item["new"] == {"unit": "mm", "count": 21, "least": 0, "largest": 40}
        assert item["change"] == 1, "the largest change by the largest value"
        (item,) = self.differ({"value": [1.0, 2.0], "unit": "mm"}, {"value": [1.0, 1.0], "unit": "mm"})
        assert (item["old"]["value"], item["change"]) == ([1, 2], -0.5)

    def test_arrays_of_other_shapes(self):
        (item,) = self.differ({"value": [1, 2], "unit": "mm"}, {"value": 1, "unit": "mm"})
        assert "change" not in item

    def test_a_tolerance_counts(self):
        old = {"value": 1, "unit": "mm"}
        assert len(self.differ(old, {**old, "plus": "0.1 mm"})) == 1
        assert self.differ({**old, "from": "given"}, {**old, "from": "default"}) == []

    def test_an_unknown_unit_of_an_old_program_is_shown(self):
        assert len(self.differ({"value": 1, "unit": "furlongs"}, {"value": 2, "unit": "furlongs"})) == 1


def test_verdicts_that_are_stored_are_compared(served, http):
    """As the contract of criteria stores them; a design of before has none."""
    from app.storage.tables import RevisionRow

    database = served.app.state.services.database
    id, before = (created(http, paper(name=name))["id"] for name in ("judged", "of before"))
    judged = {"name": "film.film", "words": "film", "require": "1 <= 2", "verdict": "met", "utilisation": 0.9}

    def store(session):
        row = session.get(RevisionRow, (id, 1))
        row.results = {**row.results, "criteria": [judged, {**judged, "name": "film.load"}]}

        old = session.get(RevisionRow, (before, 1))
        old.results = {name: part for name, part in old.results.items() if name != "criteria"}

    database.write(store)
    comparison = compared(http, before, design=id)
    assert by_name(comparison["criteria"])["film.film"] == {
        "name": "film.film",
        "old": None,
        "new": {"verdict": "met", "utilisation": 0.9},
    }
    assert compared(http, id, revision=1, **{"with": 1})["criteria"] == []
    assert faults(http.get(f"{DESIGNS}/{id}/compare", params={"units": "metric"})).keys() == {"units"}
