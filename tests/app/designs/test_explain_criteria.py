"""An explanation traces a verdict to its value, formula and inputs, and its limit to the source."""

import re

import pytest
from patience import until
from serving import API, created, problem
from test_design_criteria import FILM

DESIGNS = f"{API}/designs"


@pytest.fixture(scope="module")
def design(http):
    limits = {"permissible_film": "= half * 4 um", "bearing_material": "tin_babbitt_b23_2"}
    limits |= {"permissible_temperature": "120 degC"}
    step = {"template": "oil_film", "version": 2, "level": "map", "inputs": FILM, "limits": limits}
    own = {"require": "film.minimum_film_thickness >= 2 um", "source": "the handbook"}
    document = {"name": "why", "parameters": {"half": "0.5"}, "steps": {"film": step}}
    return created(http, {**document, "criteria": {"own": own}})["id"]


def explained(http, design, name):
    answer = http.get(f"{DESIGNS}/{design}/explain/{name}")
    assert answer.status_code == 200, answer.text
    return answer.json()


def sides(chain):
    return {link["side"]: link for link in chain["because"]}


def test_verdict_value_formula_inputs_and_the_relation_of_the_limit(http, design):
    chain = explained(http, design, "film.own_film")
    revision = http.get(f"{DESIGNS}/{design}/revisions/1").json()
    assert chain["kind"] == "criterion"
    assert chain["criterion"] == next(c for c in revision["criteria"] if c["name"] == "film.own_film")
    value, limit = sides(chain)["value"], sides(chain)["limit"]
    assert value["name"] == "film.minimum_film_thickness"
    assert value["value"] == chain["criterion"]["value"]
    assert (value["kind"], value["template"]["id"], bool(value["latex"])) == ("formula", "oil_film", True)
    typed = {link["name"]: link.get("typed") for link in value["because"]}
    assert typed["film.diametral_clearance"] == FILM["diametral_clearance"]
    assert (limit["name"], limit["relation"]) == ("film.limits.permissible_film", "= half * 4 um")
    assert limit["value"] == {"value": pytest.approx(2), "unit": "um"}
    assert [(link["name"], link["typed"]) for link in limit["because"]] == [("half", "0.5")]


def test_a_limit_by_hand_by_a_row_and_by_nobody(http, design):
    criteria = http.get(f"{DESIGNS}/{design}/revisions/1").json()["criteria"]
    kinds = {}
    for one in criteria:
        for link in explained(http, design, one["name"])["because"]:
            if link["side"] == "limit":
                kinds.setdefault(link["kind"], []).append((one, link))
    assert kinds.keys() >= {"given", "library_row", "not_given", "relation", "written"}
    for one, link in kinds["not_given"]:
        assert one["verdict"] == "not_checked"
        assert link["name"].replace(".limits.", ".") in one["give"] or link["name"] in one["give"]
    for one, link in kinds["library_row"]:
        assert (link["library"], link["typed"]) == ("bearing_material", "tin_babbitt_b23_2")
        assert link["source"] in one["source"]
    assert ("film.limits.permissible_temperature", "120 degC") in [
        (link["name"], link.get("typed")) for _, link in kinds["given"]
    ]


def test_a_criterion_of_the_design_and_the_number_in_it(http, design):
    limit = sides(explained(http, design, "own"))["limit"]
    assert limit == {"name": "2 um", "kind": "written", "source": "the handbook", "side": "limit"}
    assert explained(http, design, "criteria.own") == explained(http, design, "own")


def test_every_criterion_of_the_design_has_its_chain(http, design):
    for one in http.get(f"{DESIGNS}/{design}/revisions/1").json()["criteria"]:
        chain = explained(http, design, one["name"])
        assert sides(chain).keys() == {"value", "limit"}
        assert chain["criterion"]["verdict"] == one["verdict"]


def test_an_unknown_name_lists_what_there_is(http, design):
    refusal = problem(http.get(f"{DESIGNS}/{design}/explain/film.flim"), 404, "not-found")
    assert "film.film" in refusal["detail"]


def test_a_design_without_models_says_that_criteria_can_be_explained(http, design):
    detail = problem(http.get(f"{DESIGNS}/{design}/explain/colour"), 404, "not-found")["detail"]
    assert detail.startswith(
        "nothing that can be explained is called 'colour'; there are verdicts of criteria ("
    )
    assert "parameters of models" not in detail


def test_a_design_without_models_and_criteria_says_that_it_has_none(http):
    bare = created(http, {"name": "bare", "parameters": {"half": "0.5"}})["id"]
    detail = problem(http.get(f"{DESIGNS}/{bare}/explain/half"), 404, "not-found")["detail"]
    assert detail == (
        "nothing that can be explained is called 'half'; parameters of models and verdicts of criteria "
        "can be explained, and this design has neither models nor criteria"
    )


def test_an_explanation_in_american_units(http, client, design):
    si, us = explained(http, design, "own"), explained(http, design, "own?units=us")
    assert us["criterion"]["value"]["unit"] == "thou"
    value, metric = sides(us)["value"], sides(si)["value"]
    assert value["value"] == {"value": pytest.approx(metric["value"]["value"] / 25.4), "unit": "thou"}
    assert [link.get("typed") for link in value["because"]] == [
        link.get("typed") for link in metric["because"]
    ]
    slopes = {one["name"]: one for one in us["sensitivities"]}
    metric_slopes = {one["name"]: one for one in si["sensitivities"]}
    load, newtons = slopes["film.radial_load"], metric_slopes["film.radial_load"]
    assert load["slope"]["unit"] == "thou/lbf"
    assert load["slope"]["value"] == pytest.approx(newtons["slope"]["value"] / 25.4 * 4.4482216152605)
    oil = slopes["film.oil_inlet_temperature"]["slope"]
    assert oil["unit"] == "thou/delta_degF"
    assert oil["value"] == pytest.approx(
        metric_slopes["film.oil_inlet_temperature"]["slope"]["value"] / 25.4 / 1.8
    )
    elasticities = {name: one.get("elasticity") for name, one in metric_slopes.items()}
    assert {name: one.get("elasticity") for name, one in slopes.items()} == elasticities
    assert client.explain(design, "own", units="us").plain() == us


def test_the_page_says_where_a_verdict_comes_from(http, design):
    page = http.get(f"/designs/{design}").text
    assert f'href="/designs/{design}/explain/film.own_film"' in page
    shown = http.get(f"/designs/{design}/explain/film.own_film")
    assert shown.status_code == 200
    text = " ".join(re.sub(r"<[^>]+>", " ", shown.text).split())
    assert "Where the verdict of film.own_film comes from" in text
    assert "limit: film.limits.permissible_film = 2 µm = half * 4 um" in text


def test_the_sensitivities_of_a_verdict_and_their_page(http, design):
    chain = explained(http, design, "film.own_film")
    by_name = {one["name"]: one for one in chain["sensitivities"]}
    assert by_name["half"]["slope"] == {"value": 0, "unit": "um"}
    assert (by_name["half"]["elasticity"], by_name["half"]["helps"]) == (0, "decrease")
    load = by_name["film.radial_load"]
    assert (load["slope"]["unit"], load["helps"]) == ("um/N", "decrease")
    assert load["elasticity"] < 0
    assert "reason" not in chain
    page = http.get(f"/designs/{design}/explain/film.own_film").text
    line = re.search(r'<tr><th scope="row">film\.radial_load</th>.*?</tr>', page)
    assert line
    assert "um/N" in line[0].replace("µ", "u")
    assert 'class="bar falls"' in line[0]
    assert "lower it" in line[0]


def test_the_client_explains_a_criterion(client, design):
    chain = client.explain(design, "own")
    assert chain.criterion.verdict == "met"
    assert chain.because[-1].kind == "written"
    assert "film.radial_load" in {one.name for one in chain.sensitivities}


def test_an_explanation_that_takes_long_goes_on_as_a_job(http):
    step = {
        "template": "oil_film",
        "version": 2,
        "level": "mass_conserving",
        "inputs": {**FILM, "speed": [f"{2345 + point} rpm" for point in range(5)]},
    }
    own = {"own": {"require": "film.minimum_film_thickness >= 2 um"}}
    later, document = {"Prefer": "respond-async"}, {"name": "long", "steps": {"film": step}, "criteria": own}
    id = http.post(DESIGNS, json=document, headers=later).json()["id"]
    answer = http.get(f"{DESIGNS}/{id}/explain/own", headers=later)
    assert answer.status_code == 202, answer.text
    job = answer.headers["Location"]
    until(lambda: http.get(job).json()["state"] == "done")
    chain = http.get(http.get(job).json()["result"]).json()
    assert chain == explained(http, id, "own")
    assert sides(chain)["value"]["name"] == "film.minimum_film_thickness"
    assert "nothing" in problem(http.get(f"{DESIGNS}/{id}/explain/nothing"), 404, "not-found")["detail"]
