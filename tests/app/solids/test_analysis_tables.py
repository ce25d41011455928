"""Tables as outputs of analyses are stored, answered, shown, and passed to a step by a relation.

The solver is replaced by rows that it would have written; one slow test goes the whole way.
"""

import json
from hashlib import sha256
from importlib.metadata import version

import numpy as np
import pytest
from serving import API, created, faults, revision

from app.solids import analysis_rows as repository
from app.solids.questions import Options, question
from cad.analysis.kinds import KINDS, TABLES
from templates.core.language.evaluate import evaluate
from templates.door import built_in

DESIGNS = f"{API}/designs"
ANALYSES = f"{API}/models/crank_throw/versions/1/analyses"
SIZES = {
    "journal_diameter": "55 mm", "journal_length": "26 mm", "pin_diameter": "48 mm", "pin_length": "32 mm",
    "web_thickness": "18 mm", "web_width": "80 mm", "throw": "43 mm", "fillet": "3 mm",
}  # fmt: skip
FORCES = {
    "force_1": {"value": [4, 10, 46, 22, 8, 2, -6, -9], "unit": "kN"},
    "force_2": {"value": [0, 12, 9, 14, 6, 1, -2, -8], "unit": "kN"},
}
STEEL = {"ultimate_strength": "900 MPa"}
RELATED = {f"stress_of_{force}": f"= throw.unit_loads.stress_of_{force}" for force in FORCES}
ALONG = [[0.1, 0.2, 3.0, 0.3, 0.4, 1.0], [0.0, 0.0, -2.0, 0.0, 0.5, 0.0], [1.0, 0.5, 0.25, 0.0, 0.0, 2.0]]
ACROSS = [[1.0, 0.0, 0.0, 0.0, 2.0, 0.0], [0.0, 1.0, 0.0, 0.0, 3.0, 0.0], [0.5, 0.0, 0.0, 0.5, 0.0, 0.5]]
STUB = {"stress_of_force_1": ALONG, "stress_of_force_2": ACROSS, "points": [[43.0, 24.0, 15.0]] * 3}
MESH = {"elements": 10, "degrees_of_freedom": 90, "order": 2, "mirror_plane": None}


def throw(analyses=None, **sizes):
    declared = {"unit_loads": {"level": "coarse"}} if analyses is None else analyses
    return {
        "id": "crank_throw", "version": 1, "parameters": {**SIZES, **sizes}, "analyses": declared,
    }  # fmt: skip


def life(analyses=None, inputs=None, sizes=None, **more):
    """From a throw's solid to the life of its fillets."""
    inputs = {**STEEL, **FORCES, **RELATED} if inputs is None else inputs
    return {
        "name": "life of a throw",
        "models": {"throw": throw(analyses, **(sizes or {}))},
        "steps": {"life": {"template": "fatigue_life", "version": 1, "inputs": inputs}},
        **more,
    }


def table(name, value, **more):
    return {
        "value": value, "unit": KINDS["unit_loads"][name], "columns": [*TABLES[name]], "error": None,
        "error_reason": "not estimated", "level": "coarse", "mesh": MESH, "seconds": 0.5, **more,
    }  # fmt: skip


def answered_by_stub(http, served, outputs, **sizes):
    """Build the throw, then write what a solver would have answered about it."""
    alone = {"name": "throw", "models": {"throw": throw(**sizes)}}
    build = revision(http, created(http, alone))["models"]["throw"]["build"]
    asked = question("unit_loads", Options(level="coarse"))
    served.app.state.services.database.write(lambda session: repository.add(session, build, asked, outputs))
    return asked.key(build)


@pytest.fixture(scope="module")
def key(http, served):
    return answered_by_stub(http, served, {name: table(name, value) for name, value in STUB.items()})


@pytest.fixture(scope="module")
def design(http, key):
    design = created(http, life())
    assert design["state"] == "current", design["problem"]
    return design


class TestAnswer:
    def test_the_interface_answers_rows_with_unit_and_columns(self, http, key):
        outputs = http.get(f"{API}/analyses/{key}").json()["outputs"]
        assert outputs["stress_of_force_1"]["value"] == ALONG
        assert outputs["stress_of_force_1"]["unit"] == "MPa/kN"
        assert outputs["stress_of_force_1"]["columns"] == ["xx", "yy", "zz", "xy", "yz", "xz"]
        assert outputs["points"]["columns"] == ["x", "y", "z"]
        assert outputs["points"]["error"] is None
        assert outputs["points"]["error_reason"] == "not estimated"

    def test_a_table_is_proportional_to_no_load(self, http, key):
        """Loads belong to torsion and bending: a table stays the one under its unit."""
        outputs = http.get(f"{API}/analyses/{key}?load=500 N*m").json()["outputs"]
        assert outputs["stress_of_force_2"]["value"] == ACROSS

    def test_the_schema_of_a_model_names_tables_and_columns(self, http):
        offered = http.get(f"{API}/models/crank_throw/versions/1").json()["analyses"]
        assert offered["unit_loads"]["outputs"]["stress_of_moment_1"] == "MPa/(kN*m)"
        assert offered["unit_loads"]["tables"]["points"] == ["x", "y", "z"]
        assert offered["torsion"]["tables"] == {}
        assert "surface" not in offered["unit_loads"]["outputs"]
        other = http.get(f"{API}/models/bar/versions/1").json()["analyses"]
        assert other.keys() == {"torsion", "bending"}

    @pytest.mark.slow
    def test_the_schema_of_the_interface_allows_rows(self, http):
        schemas = http.get("/openapi.json").json()["components"]["schemas"]
        kinds = [one.get("type") for one in schemas["AnalysisOutput"]["properties"]["value"]["anyOf"]]
        assert {"number", "array", "null"} <= {*kinds}


class TestRelation:
    def test_a_step_takes_the_tables_of_the_solid(self, http, design):
        answer = revision(http, design)
        alone = {
            "stress_of_force_1": {"value": ALONG, "unit": "MPa/kN"},
            "stress_of_force_2": {"value": ACROSS, "unit": "MPa/kN"},
        }
        expected = evaluate(built_in().get("fatigue_life", 1), {**STEEL, **FORCES, **alone}).outputs
        outputs = answer["steps"]["life"]["outputs"]
        for name in ("greatest_von_mises", "safety_factor", "equivalent_amplitude", "governing_point"):
            assert outputs[name]["value"] == pytest.approx(expected[name].value, rel=1e-9), name

    def test_only_what_is_used_is_in_the_revision(self, http, design):
        analysis = revision(http, design)["models"]["throw"]["analyses"]["unit_loads"]
        assert analysis["outputs"].keys() == {"stress_of_force_1", "stress_of_force_2"}
        assert analysis["outputs"]["stress_of_force_1"]["value"] == ALONG

    def test_a_relation_calculates_with_a_table(self, http, key):
        """Twice the stress is half the safety factor: on a table as on a number."""
        doubled = {name: f"{relation} * 2" for name, relation in RELATED.items()}
        answers = [
            revision(http, created(http, life(inputs={**STEEL, **FORCES, **tables})))["steps"]["life"][
                "outputs"
            ]
            for tables in (RELATED, doubled)
        ]
        once, twice = (np.array(one["greatest_von_mises"]["value"]) for one in answers)
        assert twice == pytest.approx(2 * once, rel=1e-9)

    @pytest.mark.slow
    def test_page_and_files_show_it(self, http, design):
        page = http.get(f"/designs/{design['id']}").text
        assert 'data-table="stress_of_force_1"' in page
        assert "<summary>All 3 rows</summary>" in page
        assert "not estimated" in page
        report = http.get(f"{DESIGNS}/{design['id']}/report.html").text
        assert "stress of force 1" in report
        assert "not estimated" in report
        assert http.get(f"{DESIGNS}/{design['id']}/worksheet.xlsx").status_code == 200
        rows = http.get(f"{DESIGNS}/{design['id']}/worksheet.csv").text.splitlines()
        named = [row for row in rows if ",unit_loads.stress_of_force_1," in row]
        assert len(named) == 18
        assert any(",2 3,-2" in row for row in named)

    def test_it_is_previewed_and_named(self, http, design):
        url = f"{DESIGNS}/{design['id']}"
        change = http.post(f"{url}/preview", json={}).json()["outputs"]["throw.unit_loads.stress_of_force_1"]
        assert change["old"]["value"] == change["new"]["value"] == ALONG
        network = http.get(f"{url}/network").json()
        named = {name["name"]: name["unit"] for name in network["names"]}
        assert named["throw.unit_loads.stress_of_moment_3"] == "MPa/(kN*m)"


class TestRefused:
    def refused(self, http, document):
        answer = http.post(DESIGNS, json=document)
        assert answer.status_code == 422, answer.text
        return faults(answer), answer.json()["errors"][0]["detail"]

    @pytest.mark.parametrize(
        ("options", "name"),
        [
            ({"boundary": "guided_end"}, "boundary"),
            ({"tolerance": 0.01}, "tolerance"),
            ({"load": "1 N*m"}, "load"),
        ],
    )
    def test_options_that_tables_do_not_have(self, http, options, name):
        body = {"parameters": SIZES, **options}
        assert faults(http.post(f"{ANALYSES}/unit_loads", json=body)) == {name: "not_offered"}
        named, detail = self.refused(http, life({"unit_loads": options}))
        assert named == {f"models.throw.analyses.unit_loads.{name}": "not_offered"}
        assert name in detail or "level" in detail

    def test_a_solid_that_is_no_throw(self, http):
        bar = {"parameters": {"diameter": "20 mm", "length": "40 mm"}}
        answer = http.post(f"{API}/models/bar/versions/1/analyses/unit_loads", json=bar)
        assert faults(answer) == {"model": "no_throw"}
        model = {"id": "bar", "version": 1, **bar, "analyses": {"unit_loads": {}}}
        named, detail = self.refused(http, {"name": "bar", "models": {"bar": model}})
        assert named == {"models.bar.analyses": "no_throw"}
        assert "crank_throw" in detail

    def test_a_table_has_no_surface(self, http):
        answer = http.post(f"{ANALYSES}/unit_loads", json={"parameters": SIZES, "outputs": ["surface"]})
        assert faults(answer) == {"outputs": "unknown_name"}

    def test_a_reason_instead_of_a_table(self, http, served):
        none = table("stress_of_force_1", None, reason="no fillet")
        answered_by_stub(http, served, dict.fromkeys(RELATED, none), fillet="2.5 mm")
        named, detail = self.refused(http, life(sizes={"fillet": "2.5 mm"}))
        assert named == {f"life.{name}": "no_value" for name in RELATED}
        assert "no fillet" in detail

    def test_unit(self, http, key):
        inputs = {**STEEL, **FORCES, **RELATED, "stress_of_force_1": "= throw.unit_loads.stress_of_moment_1"}
        named, _ = self.refused(http, life(inputs=inputs))
        assert named == {"life.stress_of_force_1": "unit_mismatch"}

    def test_a_model_takes_no_table(self, http, key):
        document = life()
        document["models"]["second"] = throw({}, web_width="= throw.unit_loads.points")
        named, _ = self.refused(http, document)
        assert named == {"second.web_width": "not_a_number"}

    def test_no_iteration_runs_through_a_table(self, http, key):
        iterations = [{"through": "throw.unit_loads.points", "start": "1 mm"}]
        named, detail = self.refused(http, life(iterations=iterations))
        assert named == {"iterations": "not_a_number"}
        assert "table" in detail

    def test_a_study_says_that_it_takes_no_table(self, http, design):
        body = {
            "design": design["id"], "method": "table", "outputs": ["life.greatest_von_mises"],
            "rows": {"life.ultimate_strength": {"value": [800, 900], "unit": "MPa"}},
        }  # fmt: skip
        answer = http.post(f"{API}/studies", json=body)
        assert answer.status_code == 422, answer.text
        named = {error["name"]: error for error in answer.json()["errors"]}
        assert named.keys() == {f"throw.unit_loads.{name}" for name in RELATED}
        assert "is a table" in named["throw.unit_loads.stress_of_force_1"]["detail"]


@pytest.mark.parametrize(
    ("kind", "options", "identity"),
    [
        ("torsion", {"level": "coarse"}, ("free_end", "coarse", None)),
        ("bending", {"tolerance": 0.01, "boundary": "guided_end"}, ("guided_end", None, 0.01)),
    ],
)
def test_keys_of_analyses_are_those_of_before(kind, options, identity):
    """As they were made before tables but for the recipe: the kind, and how it was asked."""
    boundary, level, tolerance = identity
    asked = {"boundary": boundary, "kind": kind, "level": level, "tolerance": tolerance}
    text = json.dumps(["build", asked, f"recipe 8, ngsolve {version('ngsolve')}"])
    assert question(kind, Options(**options)).key("build") == sha256(text.encode()).hexdigest()


@pytest.mark.slow
class TestSolver:
    """The whole way with real finite elements, at the coarse level."""

    def test_from_the_solid_to_life(self, http):
        sizes = {"fillet": "4 mm"}
        design = created(http, life(sizes=sizes))
        assert design["state"] == "current", design["problem"]
        answer = revision(http, design)
        analysis = answer["models"]["throw"]["analyses"]["unit_loads"]
        outputs = http.get(f"{API}/analyses/{analysis['id']}").json()["outputs"]
        assert outputs.keys() == KINDS["unit_loads"].keys()
        assert {len(one["value"]) for one in outputs.values()} == {96}
        # Each point lies in a fillet: of the pin or of a journal, within a tenth of the radius.
        x, y, z = np.array(outputs["points"]["value"]).T
        pin = np.hypot(x - 43, y) < 24 + 4.5
        journal = (np.hypot(x, y) < 27.5 + 4.5) & (np.abs(z) > 16 + 18 - 0.5)
        assert np.all(pin | journal)
        assert pin.sum() >= 48
        tables = {name: {"value": outputs[name]["value"], "unit": outputs[name]["unit"]} for name in RELATED}
        alone = evaluate(built_in().get("fatigue_life", 1), {**STEEL, **FORCES, **tables}).outputs
        safety = answer["steps"]["life"]["outputs"]["safety_factor"]["value"]
        assert safety == pytest.approx(alone["safety_factor"].value, rel=1e-9)
        # A force of 46 kN on mid-pin bends the pin: nominal M/W = F l/4 / W with l between the mains'
        # middles, raised by the fillet and lowered by the webs: the same order.
        nominal = 46e3 * (32 + 36 + 26) / 4 / (np.pi / 32 * 48**3)
        greatest = max(answer["steps"]["life"]["outputs"]["greatest_von_mises"]["value"])
        assert 0.5 * nominal < greatest < 4 * nominal

    def test_a_sharp_throw_has_a_reason(self, http):
        body = {"parameters": {**SIZES, "fillet": "0 mm"}, "level": "coarse", "outputs": ["points"]}
        answer = http.post(f"{ANALYSES}/unit_loads", json=body, headers={"Prefer": "wait=60"}).json()
        assert answer["outputs"]["points"]["value"] is None
        assert "fillet" in answer["outputs"]["points"]["reason"]
