"""The worksheet of a design over HTTP: lines, checks, plots, variants, revisions, previews and refusals."""

import math

import pytest
from patience import until
from serving import API, created, faults, patched, revision

from templates import get

EXAMPLE = get("oil_film", 2).example
FILM = {"template": "oil_film", "version": 2, "inputs": {**EXAMPLE, "diametral_clearance": "= clearance"}}
TEXT = """# Notes
r [1] = film.minimum_film_thickness / 2 um "film ratio"
rise [delta_degC] = film.oil_outlet_temperature - inlet "rise"
v [m/s] = film.speed * film.bearing_diameter / 2 "sliding speed"
check r >= 1.5 "enough film" (source "own rule")
check film.minimum_film_thickness >= 2 um "not too thin"
plot r over clearance "film by clearance"
"""


def document(text=TEXT, **more):
    return {
        "name": "lines",
        "parameters": {"clearance": "55 um", "inlet": "80 degC"},
        "steps": {"film": FILM},
        "worksheet": text,
        **more,
    }


def refused(http, text, **more):
    return http.post(f"{API}/designs", json=document(text, **more))


def details(answer):
    return {fault["name"]: fault["detail"] for fault in answer.json()["errors"]}


@pytest.fixture(scope="module")
def design(http):
    return created(http, document())


@pytest.fixture(scope="module")
def lines(http, design):
    return revision(http, design)["worksheet"]["lines"]


def test_the_lines_have_the_values_of_their_formulas(design, lines):
    values = {line["name"]: line["value"] for line in lines if "value" in line}
    film = design["results"]["outputs"]["film.minimum_film_thickness"]["value"]
    assert values["worksheet.film_ratio"]["value"] == pytest.approx(film / 2, rel=1e-12)
    assert values["worksheet.rise"]["unit"] == "delta_degC"
    assert values["worksheet.rise"]["value"] == pytest.approx(7.762, abs=1e-9)
    by_hand = 5000 / 60 * 2 * math.pi * 0.048 / 2
    assert values["worksheet.sliding_speed"]["value"] == pytest.approx(by_hand, rel=1e-12)
    assert design["results"]["outputs"]["worksheet.film_ratio"] == values["worksheet.film_ratio"]
    assert [line["kind"] for line in lines] == ["prose", *["formula"] * 3, "check", "check", "plot"]
    assert lines[0]["html"] == "<h1>Notes</h1>"
    assert lines[1]["mathml"].startswith("<math")
    assert lines[-1]["reason"].startswith("there is one point only")


def test_a_check_is_a_criterion_with_the_error_of_the_step_before_it(http):
    own = {"own": {"require": "film.minimum_film_thickness >= 2 um"}}
    design = created(http, document(criteria=own))
    judged = {one["name"]: one for one in revision(http, design)["criteria"]}
    direct, checked, ratio = (judged[n] for n in ("own", "worksheet.not_too_thin", "worksheet.enough_film"))
    for name in ("verdict", "value", "limit", "margin", "utilisation", "error_known"):
        assert checked[name] == direct[name]
    assert checked["relative_error"] == pytest.approx(direct["relative_error"], rel=1e-9)
    assert ratio["relative_error"] == pytest.approx(direct["relative_error"], rel=1e-9)
    assert (ratio["verdict"], ratio["source"]) == ("not_met", "own rule")
    counts = design["results"]["verdict"]["counts"]
    assert sum(counts.values()) == len(judged)


def test_a_check_can_be_waived_and_explained(http):
    waived = {"worksheet.enough_film": {"waived": "a bench test"}}
    design = created(http, document(criteria=waived))
    judged = {one["name"]: one for one in revision(http, design)["criteria"]}
    assert judged["worksheet.enough_film"]["waived"] == "a bench test"
    why = http.get(f"{API}/designs/{design['id']}/explain/worksheet.enough_film").json()
    ratio = next(one for one in why["because"] if one["name"] == "worksheet.film_ratio")
    (film,) = ratio["because"]
    assert film["relation"] == "= film.minimum_film_thickness"
    assert film["because"][0]["name"] == "film.minimum_film_thickness"


def test_criteria_relations_columns_and_a_second_step_use_the_results(http):
    second = {**FILM, "inputs": {**FILM["inputs"], "radial_load": "= worksheet.twice_the_load"}}
    design = created(
        http,
        document(
            'W [kN] = film.radial_load * 2 "twice the load"',
            steps={"film": FILM, "second": second},
            criteria={"load": {"require": "worksheet.twice_the_load <= 60 kN"}},
            table={"columns": ["worksheet.twice_the_load", "second.minimum_film_thickness"]},
        ),
    )
    shown = revision(http, design)
    assert shown["steps"]["second"]["inputs"]["radial_load"]["value"] == pytest.approx(50000)
    assert {one["name"]: one["verdict"] for one in shown["criteria"]}["load"] == "met"
    assert "worksheet" not in shown["steps"]


def test_every_variant_has_its_own_values_and_a_plot_has_a_point_of_each(http):
    variants = {"narrow": {"clearance": "45 um"}, "wide": {"clearance": "70 um"}}
    design = created(http, document(variants=variants))
    plot = revision(http, design)["worksheet"]["lines"][-1]["plot"]
    ratios = plot["y"]["values"]["value"]
    assert plot["rows"] == ["design", "narrow", "wide"]
    assert plot["x"]["values"] == {"value": pytest.approx([55, 45, 70]), "unit": "um"}
    for clearance, ratio in zip((55, 45, 70), ratios, strict=True):
        alone = created(http, document(parameters={"clearance": f"{clearance} um", "inlet": "80 degC"}))
        own = alone["results"]["outputs"]["worksheet.film_ratio"]["value"]
        assert ratio == pytest.approx(own, rel=1e-9)
    shown = http.get(f"{API}/designs/{design['id']}/variants").json()
    names = [column["name"] for column in shown["table"]["columns"]]
    place = names.index("worksheet.film_ratio")
    assert [row["values"][place] for row in shown["table"]["rows"]] == pytest.approx(ratios)
    assert all(any(c["name"] == "worksheet.enough_film" for c in row["criteria"]) for row in shown["rows"])


def test_a_change_makes_a_revision_and_null_removes_the_lines(http):
    design = created(http, document())
    changed = patched(http, design, {"worksheet": 'k [1] = clearance / 10 um "ratio of sizes"'})
    assert changed["revision"] == 2
    assert changed["results"]["outputs"]["worksheet.ratio_of_sizes"]["value"] == pytest.approx(5.5)
    assert revision(http, design, 1)["worksheet"]["text"] == TEXT
    moved = patched(http, changed, {"parameters": {"clearance": "60 um"}})
    assert moved["results"]["outputs"]["worksheet.ratio_of_sizes"]["value"] == pytest.approx(6)
    without = patched(http, moved, {"worksheet": None})
    assert "worksheet" not in without
    assert "worksheet" not in revision(http, without)


def test_a_preview_has_the_lines_and_saves_nothing(http, design):
    patch = {"worksheet": 'k [1] = clearance / 10 um "ratio of sizes"\ncheck k >= 6 "large"'}
    seen = http.post(f"{API}/designs/{design['id']}/preview", json=patch).json()
    assert seen["worksheet"][0]["value"] == {"value": pytest.approx(5.5), "unit": "1"}
    assert {one["name"]: one["verdict"] for one in seen["criteria"]}["worksheet.large"] == "not_met"
    assert http.get(f"{API}/designs/{design['id']}").json()["revision"] == design["revision"]


@pytest.mark.parametrize(
    ("text", "code", "words"),
    [
        ('q [mm] = film.power_loss "x"', "unit_mismatch", "line 1, column 10: q is declared in mm, but"),
        ('q [W] = film.power_los "x"', "unknown_name", "did you mean film.power_loss"),
        ('> prose\nq [1] = foo "x"', "unknown_name", "line 2, column 9: name 'foo' is unknown"),
        ('q [1] = film.viscosity_law "x"', "unknown_name", "is not a number or a list of numbers"),
        ('q [1] = inlet / 1 degC "x"', "unit_mismatch", "line 1, column"),
        ('n [Hz] = film.speed "y"', "unit_mismatch", "n is declared in Hz"),
        ('given x [mm] "x"', "not_here", "make it a parameter of the design"),
        ('clearance [um] = 2 um "x"', "name", "clearance is a parameter of the design"),
        ("check clearance == 3 um \"x\"", "check", "a check needs exactly one <= or >="),
        ("plot clearance over nothing", "unknown_name", "line 1, column 21"),
        ("a [1] = b \"x\"\nb [1] = a \"y\"", "loop", "follow from each other"),
        ("q [1] = = 2", "syntax", "line 1, column 9"),
        ("\x07", "syntax", "not a letter, digit or sign"),
    ],
)  # fmt: skip
def test_a_wrong_line_is_refused_with_line_column_and_remedy(http, text, code, words):
    answer = refused(http, text)
    assert code in faults(answer).values(), answer.text
    assert any(words in detail for detail in details(answer).values()), details(answer)


def test_a_circle_is_refused_by_a_sentence_that_names_it(http):
    text = 'w [um] = film.minimum_film_thickness * 20 "own clearance"'
    through = {"film": {**FILM, "inputs": {**EXAMPLE, "diametral_clearance": "= worksheet.own_clearance"}}}
    answer = refused(http, text, steps=through)
    assert "loop" in faults(answer).values()
    (detail,) = details(answer).values()
    assert "worksheet" in detail
    assert "the lines of the worksheet are calculated together" in detail
    own = refused(http, text, parameters={"clearance": "= worksheet.own_clearance", "inlet": "80 degC"})
    assert "loop" in faults(own).values()


def test_a_solid_may_follow_from_a_line_but_not_from_one_that_uses_the_solid(http):
    model = {"shell": {"id": "plain_bearing", "parameters": {"inner_diameter": "= worksheet.bore"}}}
    text = 'b [mm] = film.bearing_diameter + clearance "bore"'
    design = created(http, document(text, models=model))
    inner = revision(http, design)["models"]["shell"]["parameters"]["inner_diameter"]
    assert inner["value"] == pytest.approx(48.055)
    answer = refused(http, f'{text}\nm [kg] = shell.mass * 2 "both"', models=model)
    assert "loop" in faults(answer).values()


def test_a_name_that_two_values_have_is_refused(http):
    answer = refused(http, TEXT, parameters={"worksheet": "1 mm", "clearance": "55 um", "inlet": "80 degC"})
    assert "rename the value" in answer.text


def test_the_report_has_every_line_with_value_verdict_and_plot(http):
    variants = {"narrow": {"clearance": "45 um"}, "wide": {"clearance": "70 um"}}
    design = created(http, document(variants=variants))
    page = http.get(f"{API}/designs/{design['id']}/report.html").text
    section = page[page.index("Worksheet of the design") :]
    assert all(words in section for words in ("Film ratio", "Enough film", "<svg", "Film by clearance"))
    table = http.get(f"{API}/designs/{design['id']}/worksheet.csv").text
    assert "worksheet,output,film_ratio" in table
    pdf = http.get(f"{API}/designs/{design['id']}/report.pdf", timeout=120)
    assert pdf.content.startswith(b"%PDF")


def test_lists_are_calculated_along_their_axis_and_plotted(http):
    pad = {"template": "slider_bearing", "version": 1, "inputs": get("slider_bearing", 1).example}
    text = (
        'q [MPa] over pad.place_along_pad = pad.pressure * 2 "twice the pressure"\n'
        'm [MPa] = max(q) "largest"\nplot q over pad.place_along_pad'
    )
    design = created(http, {"name": "pad", "steps": {"pad": pad}, "worksheet": text})
    shown = revision(http, design)
    twice, largest, drawn = shown["worksheet"]["lines"]
    pressure = shown["steps"]["pad"]["outputs"]["pressure"]["value"]
    assert twice["value"]["value"] == pytest.approx([2 * one for one in pressure])
    assert largest["value"]["value"] == pytest.approx(2 * max(pressure))
    assert drawn["plot"]["y"]["values"]["value"] == twice["value"]["value"]
    assert len(drawn["plot"]["x"]["values"]["value"]) == len(pressure)
    assert "rows" not in drawn["plot"]


@pytest.mark.slow
def test_solve_studies_tolerances_and_decide_use_lines(http, design):
    path = f"{API}/designs/{design['id']}"
    asked = {"unknown": "clearance", "between": ["20 um", "90 um"], "target": {"worksheet.film_ratio": "1.4"}}
    solved = http.post(f"{path}/solve", json=asked, headers={"Prefer": "wait=60"}).json()
    (root,) = solved["roots"]
    at = {"clearance": {"value": root["value"], "unit": root["unit"]}, "inlet": "80 degC"}
    ratio = created(http, document(parameters=at))["results"]["outputs"]["worksheet.film_ratio"]["value"]
    assert ratio == pytest.approx(1.4, rel=1e-4)
    body = {"design": design["id"], "method": "grid", "steps": 3}
    body |= {"vary": {"clearance": {"between": ["45 um", "65 um"]}}, "outputs": ["worksheet.film_ratio"]}
    body |= {"hold": ["worksheet.enough_film"]}
    study = http.post(f"{API}/studies", json=body).json()["id"]
    until(lambda: http.get(f"{API}/studies/{study}").json()["state"] in ("done", "failed"))
    rows = http.get(f"{API}/studies/{study}/rows").json()
    assert "worksheet.film_ratio" in str(rows)
    assert http.get(f"{API}/studies/{study}").json()["state"] == "done"
    decided = http.post(f"{path}/decide", json={}, headers={"Prefer": "wait=60"})
    assert decided.status_code in (200, 202), decided.text
    loose = created(http, document(parameters={"clearance": "55 +/- 5 um", "inlet": "80 degC"}))
    asked = {"outputs": ["worksheet.film_ratio"]}
    answer = http.post(f"{API}/designs/{loose['id']}/tolerance", json=asked, headers={"Prefer": "wait=60"})
    assert answer.status_code == 200, answer.text
    assert "worksheet.film_ratio" in answer.text


def test_copies_comparisons_and_restored_revisions_have_the_lines(http):
    design = created(http, document())
    path = f"{API}/designs/{design['id']}"
    changed = patched(http, design, {"worksheet": f'{TEXT}k [1] = 2 "two"'})
    compared = http.get(f"{path}/compare").json()
    (lines,) = (one for one in compared["relations"] if one["name"] == "worksheet")
    assert {lines["old"], lines["new"]} == {TEXT, f'{TEXT}k [1] = 2 "two"'}
    restored = http.post(f"{path}/revisions/1/restore", json={}, headers={"Prefer": "wait=60"}).json()
    assert restored["worksheet"] == TEXT
    page = http.get(f"/designs/{design['id']}/revisions/2?with=1").text
    assert all(part in page for part in ("worksheet.two", "film ratio", "line-value"))
    copy = http.post(f"{path}/copy", json={}, headers={"Prefer": "wait=60"}).json()
    assert copy["worksheet"] == TEXT
    assert changed["revision"] == 2


def test_lines_beyond_the_limit_are_refused_with_their_number_and_a_remedy(http):
    said = details(refused(http, "# x\n" * 4097))["worksheet"]
    assert said.startswith(
        "the lines have 16388 characters, and a design takes at most 16384; put the longer"
    )
    assert refused(http, "# x\n" * 4096).status_code < 300
