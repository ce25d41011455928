"""Auto-map proposes relations by kind, name and role of quantities, and applies nothing by itself."""

import pytest
from serving import API, created

from app.designs.automap import GENERAL
from app.designs.bodies import PAPER

DESIGNS = f"{API}/designs"


def example(http, id, version=1):
    return http.get(f"{API}/templates/{id}/versions/{version}").json()["example"]


def proposed(http, document):
    """The proposals for a design, by target; the design is as before."""
    design = created(http, document)
    place = f"{DESIGNS}/{design['id']}"
    answer = http.post(f"{place}/auto-map")
    assert answer.status_code == 200, answer.text
    assert http.get(place).json()["revision"] == 1
    return {item["target"]: item["relation"] for item in answer.json()["proposals"]}


def step(http, id, version=1):
    return {"template": id, "version": version, "inputs": example(http, id, version)}


def test_the_papers_bearing_is_tied_to_its_film(http):
    document = {**PAPER, "name": "to map", "model": {"id": "ball_bearing", "version": 1}}
    assert proposed(http, document) == {"model.inner_diameter": "= film.bearing_diameter"}


def test_the_table_of_a_standard_is_not_overruled(http):
    document = {**PAPER, "name": "6210", "model": {"id": "deep_groove_bearing", "version": 1,
                "parameters": {"designation": "6210"}}}  # fmt: skip
    assert (
        not {"model.inner_diameter", "model.outer_diameter", "model.width"} & proposed(http, document).keys()
    )


def test_a_model_takes_the_value_of_an_earlier_one_but_never_in_a_loop(http):
    document = {
        "name": "rod and shaft",
        "models": {
            "crank": {
                "id": "crank_throw",
                "parameters": {"journal_diameter": "50 mm", "pin_length": "30 mm"},
            },
            "shaft": {"id": "crankshaft", "parameters": {"pin_angles": {"value": [0, 180], "unit": "deg"}}},
        },
    }
    relations = proposed(http, document)
    assert relations["shaft.pin_length"] == "= crank.pin_length"
    assert relations["shaft.journal_diameter"] == "= crank.journal_diameter"
    assert "shaft.web_width" not in relations  # the throw's is not set
    assert not [target for target in relations if target.startswith("crank.")]
    document["models"]["crank"]["parameters"]["fillet"] = "= shaft.fillet"
    assert not [target for target in proposed(http, document) if target.startswith("shaft.")]


@pytest.mark.parametrize("names", [("assembly", "shell"), ("unit", "inlay")])
def test_models_share_labels_whatever_their_order(http, names):
    """The journal diameter of an assembly and the bore of a shell are both called bearing diameter."""
    whole, shell = names
    document = {
        "name": "assembly and shell",
        "models": {
            whole: {"id": "bearing_assembly", "parameters": {"journal_diameter": "48 mm", "width": "20 mm"}},
            shell: {"id": "plain_bearing"},
        },
    }
    relations = proposed(http, document)
    assert relations[f"{shell}.inner_diameter"] == f"= {whole}.journal_diameter"
    assert relations[f"{shell}.width"] == f"= {whole}.width"  # both are also called bearing width
    assert not [target for target in relations if target.startswith(f"{whole}.")]


def test_two_parts_of_a_kind_are_not_tied_by_general_names(http):
    document = {
        "name": "two bushes",
        "models": {
            "one": {"id": "flanged_bush", "parameters": {"wall": "2 mm", "inner_chamfer": "1 mm"}},
            "other": {"id": "flanged_bush"},
        },
    }
    assert not {"other.wall", "other.outer_diameter"} & proposed(http, document).keys()


def test_proposals_close_no_loop_among_themselves(http):
    """Each has what the other lacks; only one direction is proposed, and the design accepts all proposals."""
    document = {
        "name": "mutual",
        "models": {
            "shaft": {"id": "crankshaft", "parameters": {"pin_length": "30 mm"}},
            "crank": {"id": "crank_throw", "parameters": {"journal_diameter": "50 mm"}},
        },
    }
    relations = proposed(http, document)
    both = {"shaft.journal_diameter": "= crank.journal_diameter", "crank.pin_length": "= shaft.pin_length"}
    assert len(both.items() & relations.items()) == 1
    design = created(http, document)
    answer = http.post(f"{DESIGNS}/{design['id']}/auto-map?apply=true", headers={"If-Match": '"1"'})
    assert answer.status_code == 200, answer.text


@pytest.mark.parametrize("engine", ["flywheel", "bearing_load"])
def test_the_bore_of_a_cylinder_is_not_that_of_a_shell(http, engine):
    document = {
        "name": "bores",
        "steps": {"engine": step(http, engine)},
        "models": {"shell": {"id": "plain_bearing"}},
    }
    assert proposed(http, document) == {}
    document["steps"]["film"] = step(http, "oil_film", 2)
    assert proposed(http, document)["shell.inner_diameter"] == "= film.bearing_diameter"


def test_a_step_of_the_same_name_as_the_model_comes_first(http):
    film = step(http, "oil_film")
    document = {
        "name": "two films",
        "steps": {"front_film": film, "rear_film": film},
        "models": {"rear": {"id": "plain_bearing"}, "front_shell": {"id": "plain_bearing"}},
    }
    relations = proposed(http, document)
    assert relations["rear.inner_diameter"] == "= rear_film.bearing_diameter"
    assert relations["front_shell.inner_diameter"] == "= front_film.bearing_diameter"


def test_a_crank_is_tied_by_names_that_tell_its_parts(http):
    document = {
        "name": "crank",
        "steps": {"stiffness": step(http, "crank_stiffness")},
        "models": {"throw": {"id": "crank_throw"}},
    }
    relations = proposed(http, document)
    assert relations["throw.pin_diameter"] == "= stiffness.pin_diameter"
    assert relations["throw.throw"] == "= stiffness.throw"


def test_a_general_name_of_a_parameter_counts_as_it_stands_only(http):
    document = {
        "name": "own",
        "parameters": {"bore": "40 mm", "width": "20 mm"},
        "models": {"shell": {"id": "plain_bearing"}},
    }
    assert {"bore", "width"} <= GENERAL
    assert proposed(http, document) == {"shell.width": "= width"}
