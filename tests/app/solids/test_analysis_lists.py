"""A shaft of several throws is analysed as a chain; its lists are stored, answered and used by relations.

The solver is replaced by rows that it would have written; one slow test goes the whole way.
"""

import pytest
from serving import API, created, faults, revision

from app.solids import analysis_rows as repository
from app.solids.questions import Options, question
from cad.analysis.kinds import KINDS

DESIGNS = f"{API}/designs"
SHAFT = f"{API}/models/crankshaft/versions/1"
SIZES = {"journal_diameter": "40 mm", "throw": "30 mm", "fillet": "2 mm", "pin_angles": "[0, 180] deg"}
GUIDED = {"level": "coarse", "boundary": "guided_end"}
MESH = {"elements": 10, "degrees_of_freedom": 90, "order": 3, "mirror_plane": None}
STUB = {"stiffness": 60e3, "throw_stiffnesses": [100e3, 150e3], "torsional_frequency": 900.0}
TRAIN = {
    "inertias": ["0.01 kg*m**2", "0.01 kg*m**2", "0.2 kg*m**2"],
    "stiffnesses": ["= shaft.chain.throw_stiffnesses[1]", "= shaft.chain.throw_stiffnesses[2]"],
}


def shaft(analyses=None, **sizes):
    declared = {"chain": GUIDED} if analyses is None else analyses
    return {"id": "crankshaft", "version": 1, "parameters": {**SIZES, **sizes}, "analyses": declared}


def train(analyses=None, inputs=None, **more):
    """From a shaft's throws to the natural frequencies of its train."""
    step = {"template": "torsional_vibration", "version": 1, "inputs": inputs or TRAIN}
    return {"name": "train", "models": {"shaft": shaft(analyses)}, "steps": {"train": step}, **more}


def answered_by_stub(http, served, values, error=0.02, **sizes):
    """Build the shaft, then write what a solver would have answered about it."""
    build = revision(http, created(http, {"name": "alone", "models": {"shaft": shaft(**sizes)}}))
    build, asked = build["models"]["shaft"]["build"], question("chain", Options(**GUIDED))
    outputs = {
        name: {
            "value": value, "unit": KINDS["chain"][name], "error": error, "level": "coarse", "mesh": MESH,
            "seconds": 0.5, **({"reason": "too coarse"} if value is None else {}),
        }
        for name, value in values.items()
    }  # fmt: skip
    served.app.state.services.database.write(lambda session: repository.add(session, build, asked, outputs))
    return asked.key(build)


@pytest.fixture(scope="module")
def key(http, served):
    return answered_by_stub(http, served, STUB)


@pytest.fixture(scope="module")
def design(http, key):
    design = created(http, train())
    assert design["state"] == "current", design["problem"]
    return design


def test_a_model_says_what_its_chain_answers(http):
    offered = http.get(SHAFT).json()["analyses"]
    assert offered.keys() == {"torsion", "bending", "unit_loads", "chain"}
    assert offered["chain"]["lists"] == ["throw_stiffnesses"]
    assert offered["chain"]["tables"] == {}
    assert offered["chain"]["outputs"] == KINDS["chain"]
    assert offered["chain"]["boundaries"] == ["free_end", "guided_end"]
    assert "chain" not in http.get(f"{API}/models/crank_throw/versions/1").json()["analyses"]


def test_the_interface_answers_a_list(http, key):
    outputs = http.get(f"{API}/analyses/{key}").json()["outputs"]
    assert outputs["throw_stiffnesses"]["value"] == STUB["throw_stiffnesses"]
    assert outputs["throw_stiffnesses"]["unit"] == "N*m/rad"
    assert outputs["throw_stiffnesses"]["error"] == 0.02
    us = http.get(f"{API}/analyses/{key}?units=us").json()["outputs"]["throw_stiffnesses"]
    assert len(us["value"]) == 2


def test_a_step_takes_single_throws(http, design):
    answer = revision(http, design)
    assert answer["steps"]["train"]["inputs"]["stiffnesses"]["value"] == pytest.approx(
        [value / (1e3 if "k" in answer["steps"]["train"]["inputs"]["stiffnesses"]["unit"] else 1)
         for value in STUB["throw_stiffnesses"]], rel=1e-12,
    )  # fmt: skip
    analysis = answer["models"]["shaft"]["analyses"]["chain"]
    assert analysis["outputs"].keys() == {"throw_stiffnesses"}
    assert analysis["boundary"] == "guided_end"


def test_a_step_takes_the_whole_list(http, key, design):
    whole = created(http, train(inputs={**TRAIN, "stiffnesses": "= shaft.chain.throw_stiffnesses"}))
    assert whole["state"] == "current", whole["problem"]
    single, listed = (revision(http, one)["steps"]["train"]["outputs"] for one in (design, whole))
    assert listed == single


def test_an_item_that_is_not_there_is_refused(http, key):
    inputs = {**TRAIN, "stiffnesses": ["= shaft.chain.throw_stiffnesses[3]"] * 2}
    answer = http.post(DESIGNS, json=train(inputs=inputs))
    assert answer.status_code == 422, answer.text


@pytest.mark.slow
def test_page_report_and_table_show_it(http, design):
    page = http.get(f"/designs/{design['id']}").text
    assert 'data-analysis-output="throw_stiffnesses"' in page
    assert "under 1 N" not in page.partition("Chain <span")[2].partition("</caption>")[0]
    report = http.get(f"{DESIGNS}/{design['id']}/report.html").text
    assert "Chain: throw stiffnesses" in report
    rows = http.get(f"{DESIGNS}/{design['id']}/worksheet.csv").text.splitlines()
    assert len([row for row in rows if ",chain.throw_stiffnesses," in row]) == 2
    assert (
        http.get(f"/models/crankshaft/1?{'&'.join(f'{k}={v}' for k, v in SIZES.items())}").status_code == 200
    )


class TestRefused:
    def test_options_that_a_chain_does_not_have(self, http):
        body = {"parameters": SIZES, "load": "500 N*m"}
        assert faults(http.post(f"{SHAFT}/analyses/chain", json=body)) == {"load": "not_offered"}
        both = {"parameters": SIZES, "level": "fine", "tolerance": 0.02}
        assert faults(http.post(f"{SHAFT}/analyses/chain", json=both)) == {"tolerance": "conflict"}

    @pytest.mark.parametrize("output", ["surface", "maximum_stress"])
    def test_outputs_that_a_chain_does_not_have(self, http, output):
        answer = http.post(f"{SHAFT}/analyses/chain", json={"parameters": SIZES, "outputs": [output]})
        assert faults(answer) == {"outputs": "unknown_name"}

    @pytest.mark.parametrize("other", ["crank_throw", "bar"])
    def test_a_model_that_is_no_shaft_of_throws(self, http, other):
        answer = http.post(f"{API}/models/{other}/versions/1/analyses/chain", json={"parameters": {}})
        assert faults(answer)["model"] == "no_throws"

    def test_a_reason_instead_of_a_list(self, http, served):
        answered_by_stub(http, served, {"throw_stiffnesses": None}, 0.25, fillet="1 mm")
        document = train()
        document["models"]["shaft"] = shaft(fillet="1 mm")
        answer = http.post(DESIGNS, json=document)
        assert set(faults(answer).values()) == {"no_value"}
        assert "too coarse" in answer.text

    def test_a_study_says_that_it_takes_no_list(self, http, design):
        body = {
            "design": design["id"], "method": "table", "outputs": ["train.natural_frequencies"],
            "rows": {"train.inertias[1]": {"value": [0.01, 0.02], "unit": "kg*m**2"}},
        }  # fmt: skip
        answer = http.post(f"{API}/studies", json=body)
        assert answer.status_code == 422, answer.text


def test_a_tolerance_that_no_level_meets_is_said(http, served):
    asked = {"tolerance": 0.001, "boundary": "guided_end"}
    build = revision(http, created(http, {"name": "alone", "models": {"shaft": shaft()}}))["models"]["shaft"]
    wanted = question("chain", Options(**asked))
    outputs = {"stiffness": {
        "value": 6e4, "unit": "N*m/rad", "error": 0.004, "level": "fine", "mesh": MESH, "seconds": 1.0,
    }}  # fmt: skip
    services = served.app.state.services
    services.database.write(lambda session: repository.add(session, build["build"], wanted, outputs))
    answer = http.get(f"{API}/analyses/{wanted.key(build['build'])}").json()
    assert [warning["code"] for warning in answer["warnings"]] == ["tolerance_unmet"]


@pytest.mark.slow
class TestSolver:
    """The whole way with real finite elements, at the coarse level."""

    def asked(self, http, kind, **body):
        body = {"parameters": {**SIZES, "fillet": "3 mm"}, "level": "coarse", **body}
        answer = http.post(f"{SHAFT}/analyses/{kind}", json=body, headers={"Prefer": "wait=120"})
        assert answer.status_code == 200, answer.text
        return answer.json()["outputs"]

    def test_throws_are_in_series(self, http):
        outputs = self.asked(http, "chain", boundary="guided_end")
        assert {output["level"] for output in outputs.values()} == {"coarse"}
        first, second = outputs["throw_stiffnesses"]["value"]
        assert 1 / (1 / first + 1 / second) == pytest.approx(outputs["stiffness"]["value"], rel=1e-9)
        assert 0 < outputs["stiffness"]["error"] < 0.05
        free = self.asked(http, "chain")
        assert free["stiffness"]["value"] < outputs["stiffness"]["value"]

    def test_unit_loads_are_those_of_a_throw(self, http):
        outputs = self.asked(http, "unit_loads")
        assert {len(one["value"]) for one in outputs.values()} == {96}
        assert max(abs(z) for _, _, z in outputs["points"]["value"]) < 60
