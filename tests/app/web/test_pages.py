"""Property: the pages that the server writes are correct and complete, tested without a browser."""

import json

import pytest
from browsing import created, settled
from patience import until
from sqlalchemy import text

from app.designs.schemas.designs import Design
from app.http.guard import PAGE_POLICY
from app.presentation.input_text import text_of, value_of
from app.presentation.numbers import aligned, in_line, percent, unit
from app.web.shared.forms import kept, patch_of
from templates.physics.films.reynolds import extrapolated_film

HOSTILE = "<script>alert(1)</script>&\"'"
PAGES = (
    "/",
    "/designs",
    "/templates/oil_film/1",
    "/templates/oil_film/2?units=us",
    "/templates/third/1",
    "/models/ball_bearing/1",
    "/models/plain_bearing/1?inner_diameter=40+mm",
)


@pytest.mark.parametrize("path", PAGES)
def test_a_page_is_shown_under_the_strict_policy(http, path):
    answer = http.get(path)
    assert answer.status_code == 200
    assert answer.headers["content-type"].startswith("text/html")
    assert answer.headers["content-security-policy"] == PAGE_POLICY
    assert PAGE_POLICY.startswith("default-src 'self';")
    assert "unsafe" not in PAGE_POLICY
    assert 'style="' not in answer.text
    assert "<script>" not in answer.text


def test_the_list_of_designs_is_filtered_by_a_form(http):
    for name in ("filtered one", "filtered <two>"):
        http.post("/api/v1/designs", json={"name": name}).raise_for_status()
    page = http.get("/designs", params={"name": "FILTERED <", "state": "current", "template": ""}).text
    assert "filtered &lt;two&gt;" in page
    assert "filtered one" not in page
    assert 'value="FILTERED &lt;"' in page
    assert "<option selected>current" in page
    assert "No design fits the filter." in http.get("/designs?template=oil_film/99").text
    assert http.get("/designs?state=done").status_code == 422


@pytest.mark.parametrize("step", [5, pytest.param(1, marks=pytest.mark.slow)])
def test_every_template_and_model_has_its_page(http, step):
    """Every fifth one in the quick lane."""
    for group in ("templates", "models"):
        items = http.get(f"/api/v1/{group}", params={"limit": 500}).json()["items"]
        assert len(items) >= 5
        for item in items[::step]:
            answer = http.get(f"/{group}/{item['id']}/{item['version']}")
            assert answer.status_code == 200, item
            assert item["title"].partition(",")[0] in answer.text.replace("&#39;", "'")


def test_the_latest_version_is_where_no_version_is_named(http):
    assert http.get("/templates/oil_film").headers["location"] == "/templates/oil_film/2"


def test_the_design_page_shows_formulas_with_numbers_and_results(http, paper):
    page = http.get(paper).text
    assert 'data-output="film.minimum_film_thickness"' in page
    outputs = http.get(f"/api/v1{paper}/revisions/1").json()["steps"]["film"]["outputs"]
    whole, _, rest = f"{outputs['minimum_film_thickness']['value']:.5g}".partition(".")
    assert f'<span class="whole">{whole}</span><span class="rest">.{rest}</span>' in page
    assert 'value="= scale * 48 mm"' in page
    assert "= 50 mm" in page
    assert "stretchy" in page


def test_what_a_user_typed_is_shown_as_text_and_never_as_markup(http):
    document = {"name": HOSTILE, "parameters": {"scale": "1"}}
    design = http.post("/api/v1/designs", json=document).json()
    for path in ("/", "/designs", f"/designs/{design['id']}", f"/designs/{design['id']}/revisions/1"):
        page = http.get(path).text
        assert HOSTILE not in page
        assert "&lt;script&gt;" in page
    typed = {"revision": "1", "was": "{}", ".scale": HOSTILE, "note": HOSTILE}
    refused = http.post(f"/designs/{design['id']}", data=typed)
    assert refused.status_code == 422
    assert "<script>alert" not in refused.text


def test_a_design_without_a_part_has_no_picture_at_home(http, paper):
    bare = http.post("/api/v1/designs", json={"name": "bare"}).json()["id"]
    home = http.get("/").text
    assert f"/api/v1{paper}/models/model/model.png" in home
    assert f"/api/v1/designs/{bare}/" not in home


def test_a_missing_page_is_a_page_for_a_browser_and_a_problem_for_others(http):
    page = http.get("/nowhere")
    assert (page.status_code, page.headers["content-type"]) == (404, "text/html; charset=utf-8")
    assert "There is no such page" in page.text
    for path in ("/designs/nothing", "/templates/oil_film/99", "/templates/a b/1", "/models/none/1"):
        answer = http.get(path)
        assert answer.status_code == 404, path
        assert answer.headers["content-type"].startswith("text/html")
    for path, accept in (("/nowhere", "*/*"), ("/api/v1/nowhere", "text/html"), ("/designs/nothing", "*/*")):
        problem = http.get(path, headers={"Accept": accept})
        assert problem.status_code == 404
        assert problem.headers["content-type"] == "application/problem+json"


def test_a_form_is_saved_as_a_revision(http, paper):
    was = json.dumps({".scale": "= 50 / 48"})
    answer = http.post(paper, data={"revision": "1", "was": was, ".scale": "1", "note": "as drawn"})
    assert (answer.status_code, answer.headers["location"]) == (303, paper)
    design = settled(http, paper)
    assert (design["revision"], design["parameters"]) == (2, {"scale": "1"})
    page = http.get(paper).text
    assert "50 → " in page
    assert "as drawn" in page
    compared = http.get(f"{paper}/revisions/2").text
    assert "model.inner_diameter" in compared


def test_a_wrong_form_is_shown_again_with_the_reason_beside_the_field(http, paper):
    was = json.dumps({"film.radial_load": "25 kN", "film.speed": "5000 rpm"})
    typed = {"revision": "1", "was": was, "film.radial_load": "25 mm", "film.speed": "50 Hz"}
    answer = http.post(paper, data=typed)
    assert answer.status_code == 422
    for name in ("film-radial_load", "film-speed"):
        assert f'aria-describedby="{name}-error"' in answer.text
    assert 'value="25 mm"' in answer.text
    assert "a force is wanted" in answer.text
    assert http.get(f"/api/v1{paper}").json()["revision"] == 1


def test_a_form_on_an_older_revision_is_refused_and_keeps_what_was_typed(http, paper):
    http.patch(f"/api/v1{paper}", json={"note": "x", "name": "renamed"}, headers={"If-Match": '"1"'})
    was = json.dumps({"film.radial_load": "25 kN"})
    answer = http.post(paper, data={"revision": "1", "was": was, "film.radial_load": "27 kN"})
    assert answer.status_code == 412
    assert "Somebody else saved" in answer.text
    assert 'value="27 kN"' in answer.text


def test_a_form_from_another_site_is_refused(http, paper):
    for headers in ({"Sec-Fetch-Site": "cross-site"}, {"Origin": "http://elsewhere.example"}):
        answer = http.post(f"{paper}/delete", headers=headers)
        assert answer.status_code == 403
    assert http.get(f"/api/v1{paper}").status_code == 200


def test_a_design_is_built_up_copied_restored_and_deleted_by_forms(http):
    chosen = {"name": "own", "template": "oil_film/1", "model": "plain_bearing/1"}
    form = http.post("/designs", data=chosen).headers["location"]
    assert http.get(form).text.count('value=""') >= 7  # it begins empty
    inputs = http.get("/api/v1/templates/oil_film/versions/1").json()["example"]
    typed = {f"oil_film.{name}": value for name, value in inputs.items()}
    hidden = {"design_name": "own", "template": "oil_film/1", "model": "plain_bearing/1"}
    refused = http.post("/designs", data={**hidden, **typed, "oil_film.speed": "5 mm"})
    assert refused.status_code == 422
    assert 'aria-describedby="oil_film-speed-error"' in refused.text
    place = http.post("/designs", data={**hidden, **typed}).headers["location"]
    design = settled(http, place)
    assert design["models"]["model"]["parameters"] == {}  # a mapping is proposed, never applied on its own
    assert "model.inner_diameter = oil_film.bearing_diameter" in http.get(place).text
    chosen = {"revision": str(design["revision"]), "map.model.inner_diameter": "1"}
    http.post(f"{place}/auto-map", data=chosen)
    design = settled(http, place)
    assert design["models"]["model"]["parameters"] == {"inner_diameter": "= oil_film.bearing_diameter"}
    revision = str(design["revision"])
    more = {"revision": revision, "add": "parameter", "name": "k", "value": "2 mm"}
    http.post(f"{place}/blocks", data=more)
    design = settled(http, place)
    assert design["parameters"] == {"k": "2 mm"}
    http.post(f"{place}/blocks", data={"revision": str(design["revision"]), "remove": "parameters.k"})
    assert settled(http, place)["parameters"] == {}
    http.post(f"{place}/revisions/{design['revision']}/restore")
    assert settled(http, place)["parameters"] == {"k": "2 mm"}
    copy = http.post(f"{place}/copy").headers["location"]
    assert http.get(copy).status_code == 200
    assert http.post(f"{copy}/delete", data={"revision": "1"}).headers["location"] == "/#designs"
    assert copy.rpartition("/")[2] not in http.get("/designs").text


def test_display_units_are_kept_and_change_results_only(http):
    page = http.get("/templates/oil_film/1?units=us").text
    assert '<td class="unit">mil</td>' in page
    assert 'value="25 kN"' in page
    assert '<td class="unit">mil</td>' in http.get("/templates/oil_film/1").text
    assert '<td class="unit">µm</td>' in http.get("/templates/oil_film/1?units=si").text


def test_files_of_the_pages_are_asked_about_before_they_are_used_again(http):
    answer = http.get("/static/design/design.js")
    assert answer.headers["cache-control"] == "no-cache"
    again = http.get("/static/design/design.js", headers={"If-None-Match": answer.headers["etag"]})
    assert again.status_code == 304
    plotly = http.get("/static/plotly.min.js")
    assert plotly.headers["content-encoding"] == "gzip"
    assert plotly.text.startswith("/**\n* plotly.js")
    kept = http.get("/static/plotly.min.js", headers={"If-None-Match": plotly.headers["etag"]})
    assert kept.status_code == 304
    for path in ("%2e%2e/main.py", "site.py", "audit/routes.py", "audit/audit.html", "audit", ""):
        assert http.get(f"/static/{path}").status_code == 404, path


def test_pages_are_compressed_and_streams_are_not(http, paper):
    assert http.get(paper).headers["content-encoding"] == "gzip"
    with http.stream("GET", f"/api/v1{paper}/events") as stream:
        assert "content-encoding" not in stream.headers


def test_the_pressure_of_a_film_is_that_of_the_solution_beneath(http):
    inputs = {
        "relative_eccentricity": 0.8,
        "bearing_diameter": "50 mm",
        "bearing_width": "25 mm",
        "diametral_clearance": "50 um",
        "speed": "3000 rpm",
        "dynamic_viscosity": "20 mPa*s",
    }
    content = http.post("/api/v1/film-pressure", json={"inputs": inputs}).json()
    film, _ = extrapolated_film(0.8, 0.5)
    scale = 0.02 * 3000 * 3.141592653589793 / 30 * 1000**2 / 1e6
    assert content["maximum_pressure"]["value"] == pytest.approx(film.P_max * scale, rel=2e-3)
    rows, columns = len(content["place"]["value"]), len(content["angle"]["value"])
    assert (len(content["pressure"]["value"]), len(content["pressure"]["value"][0])) == (rows, columns)
    for wrong in (
        {"relative_eccentricity": [0.1, 0.2]},
        {"diametral_clearance": "1e-300 m"},
        {"speed": "1 m"},
    ):
        answer = http.post("/api/v1/film-pressure", json={"inputs": {**inputs, **wrong}})
        assert answer.status_code == 422
        assert answer.json()["errors"][0]["name"] in wrong


def test_a_preview_with_its_worksheet_is_what_is_saved(http, paper):
    patch = {"parameters": {"scale": "1"}}
    seen = http.post(f"/api/v1{paper}/preview?worksheet=true&units=us", json=patch).json()
    headers = {"If-Match": '"1"', "Prefer": "wait=60"}
    http.patch(f"/api/v1{paper}", json=patch, headers=headers)
    saved = http.get(f"/api/v1{paper}/revisions/2/worksheet?units=us").json()["steps"]["film"]
    assert seen["steps"]["film"]["outputs"] == saved["outputs"]
    assert seen["steps"]["film"]["formulas"] == saved["formulas"]
    film = next(row for row in saved["formulas"] if row["name"] == "minimum_film_thickness")
    assert film["result"] == r"0.12775\,\text{mil}"
    assert saved["inputs"]["bearing_diameter"] == {"value": 48.0, "unit": "mm", "from": "given"}


@pytest.mark.parametrize(
    ("value", "shown"),
    [(3.2449116, "3.2449"), (1.2e-7, "1.2·10⁻⁷"), (-50.0, "−50"), (123456.0, "123460"), (0.0, "0")],
)
def test_numbers_are_written_with_five_digits(value, shown):
    assert "".join(aligned(value)) == shown


def test_units_and_quantities_are_written_once():
    assert [unit(text) for text in ("mm**2/s", "N*m", "degC", "1", None)] == ["mm²/s", "N·m", "°C", "", ""]
    assert in_line({"value": 48.0, "unit": "mm", "plus": 0.1}) == "48 mm +0.1"
    assert in_line({"value": list(range(9)), "unit": "deg"}) == "[0, 1, 2, 3, 4, 5, 6, 7, 8] °"
    wave = [float((7 * n) % 31) for n in range(31)]
    assert in_line({"value": wave, "unit": "N"}) == "0 … 30 N (31 values; least no. 1, largest no. 23)"
    assert in_line({"value": [[1.0] * 12, [2.0] * 12], "unit": "1"}) == "1 … 2 (2 × 12 values)"
    assert in_line({"value": None, "unit": "1", "reason": "no load"}) == "no load"
    assert percent(0.24) == "24 %"


@pytest.mark.parametrize(
    ("typed", "value"),
    [
        ("25 kN", "25 kN"),
        ("= scale * 48 mm", "= scale * 48 mm"),
        ("[1, 2] mm", {"value": [1, 2], "unit": "mm"}),
        ('["= a", "3 mm"]', ["= a", "3 mm"]),
        ("[1, 2", "[1, 2"),
    ],
)
def test_a_field_means_what_it_says(typed, value):
    assert value_of(typed) == value
    assert text_of(value) == typed


def test_a_patch_holds_what_was_changed_and_nothing_else(http, paper):
    design = Design.model_validate_json(http.get(f"/api/v1{paper}").content)
    was = json.dumps({".scale": "= 50 / 48", "film.radial_load": "25 kN", "model.inner_diameter": "= x"})
    typed = {"was": was, ".scale": "= 50 / 48", "film.radial_load": "26 kN", "film@tolerance": "0.01"}
    typed |= {"model.inner_diameter": "", "note": "n", "nothing.here": "1", "scale": "3", "film@here": "1"}
    assert patch_of(design, typed) == {
        "steps": {"film": {"inputs": {"radial_load": "26 kN"}, "tolerance": 0.01}},
        "models": {"model": {"parameters": {"inner_diameter": None}}},
    }
    assert kept({"was": "no json", "a": "1"})["a"] == "1"


BUILD = "model, version, parameters, measurements, created, operated, made_by"
FILE = "kind, sha256, size, created"


def test_a_revision_made_by_an_older_recipe_gives_its_other_files(http, served, paper):
    """A build stays what it is when the recipe that makes new ones moves on."""
    build = http.get(f"/api/v1{paper}/revisions/1").json()["models"]["model"]["build"]
    names = {"older": "0" * len(build), "build": build, "design": paper.rpartition("/")[2]}
    statements = (
        f"INSERT INTO build (key, {BUILD}) SELECT :older, {BUILD} FROM build WHERE key = :build",
        f"INSERT INTO artifact (build_key, {FILE}) SELECT :older, {FILE} FROM artifact "
        "WHERE build_key = :build AND kind = 'step'",
        "UPDATE revision_model SET build_key = :older WHERE design_id = :design",
    )

    def age(session):
        for statement in statements:
            session.execute(text(statement), {n: v for n, v in names.items() if f":{n}" in statement})

    served.app.state.services.database.write(age)
    answer = http.get(f"/api/v1{paper}/model.stl", headers={"Prefer": "wait=60"})
    assert (answer.status_code, answer.headers["content-type"]) == (200, "model/stl")


def test_the_gallery_offers_only_what_can_be_made(http):
    assert created(http, "shell")


def test_a_model_of_which_only_the_step_file_is_there_is_still_being_built(http):
    """As an analysis leaves it: its page asks for what else it shows."""
    parameters = {"size": "17 mm"}
    body = {"parameters": parameters, "artifacts": ["step"]}
    path = "/api/v1/models/moody/versions/1/build"
    headers = {"Prefer": "wait=60", "Accept": "*/*"}
    key = http.post(path, json=body, headers=headers).json()["build"]
    assert http.get(f"/api/v1/builds/{key}").json()["artifacts"].keys() == {"step"}
    page = until(
        lambda: http.get("/models/moody/1", params=parameters),
        lambda page: page.status_code != 200 or "The model is being built" not in page.text,
    )
    assert page.status_code == 200
    assert "data-solid" in page.text
