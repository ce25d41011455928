"""Users edit lists, curves, analyses and iterations without JSON, by keyboard and at 390 px."""

import re

import pytest
from bare_shells import BUSH
from browsing import from_example
from openpyxl import Workbook
from playwright.sync_api import expect
from serving import API

CYCLE = "crank angle;Fx;load y\ndeg;kN;kN\n" + "".join(
    f"{angle};{x};0,5\n" for angle, x in ((0, "1,5"), (90, "-2,5"), (180, "0,5"), (270, "1"), (360, "1,5"))
)


@pytest.mark.slow
def test_a_pasted_table_fills_the_curves_of_a_template(watched, tmp_path):
    page = watched.page
    watched.open("/templates/oil_film_cycle/1")
    page.get_by_role("button", name="Paste a table into load x").click()
    dialog = page.get_by_role("dialog", name="Paste a table")
    expect(dialog.get_by_label("Table", exact=True)).to_be_focused()
    dialog.get_by_label("Table", exact=True).fill(CYCLE.replace("-2,5", "abc"))
    expect(dialog.get_by_role("alert")).to_contain_text("row 4, column Fx: 'abc' is not a number")
    expect(dialog.get_by_role("button", name="Insert")).to_be_disabled()
    dialog.get_by_label("Table", exact=True).fill(CYCLE)
    expect(dialog.get_by_role("status")).to_contain_text("the last point repeats the first and was left out")
    expect(dialog.get_by_label("Field for Fx")).to_have_value("load_x")
    dialog.get_by_label("Unit of Fx").fill("mm")
    expect(dialog.get_by_role("alert")).to_contain_text("a force is wanted")
    dialog.get_by_label("Unit of Fx").fill("N")
    dialog.get_by_label("Add to the crank angle").fill("10 deg")
    expect(dialog.locator("tbody tr").first).to_contain_text("10")
    dialog.get_by_role("button", name="Insert 4 rows").click()
    expect(page.locator("[id='-crank_angle']")).to_have_value("[10, 100, 190, 280] deg")
    expect(page.locator("[id='-load_x']")).to_have_value("[1.5, -2.5, 0.5, 1] N")
    expect(page.locator("[id='-load_y']")).to_have_value("[0.5, 0.5, 0.5, 0.5] kN")
    assert watched.faults() == []


@pytest.mark.parametrize(
    "encoding",
    ["windows-1252", *(pytest.param(one, marks=pytest.mark.slow) for one in ("utf-8-sig", "utf-16"))],
)
def test_a_file_is_read_as_a_spreadsheet_saved_it(watched, tmp_path, encoding):
    page = watched.page
    file = tmp_path / "loads.csv"
    file.write_bytes("crank angle [°]\tFx [kN]\r\n0\t1,5\r\n90\t-2\r\n".encode(encoding))
    watched.open("/templates/oil_film_cycle/1")
    page.get_by_role("button", name="Paste a table into load x").click()
    dialog = page.get_by_role("dialog", name="Paste a table")
    dialog.get_by_label("or a file").set_input_files(file)
    dialog.get_by_role("button", name="Insert 2 rows").click()
    expect(page.locator("[id='-load_x']")).to_have_value("[1.5, -2] kN")
    expect(page.locator("[id='-crank_angle']")).to_have_value("[0, 90] °")


@pytest.mark.slow
def test_a_workbook_is_chosen_as_a_file(watched, tmp_path):
    """An XLSX file is read like a pasted table; one without numbers is refused, and nothing is filled in."""
    page, file, empty = watched.page, tmp_path / "loads.xlsx", tmp_path / "empty.xlsx"
    rows = [("crank angle", "Fx", "load y"), ("deg", "kN", "kN"), (0, 1.5, 0.5), (90, -2.5, 0.25)]
    for path, lines in ((file, rows), (empty, rows[:1])):
        workbook = Workbook()
        for line in lines:
            workbook.active.append(line)
        workbook.save(path)
    watched.open("/templates/oil_film_cycle/1")
    before = page.locator("[id='-load_x']").input_value()
    page.get_by_role("button", name="Paste a table into load x").click()
    dialog = page.get_by_role("dialog", name="Paste a table")
    chosen = dialog.get_by_label("or a file")
    assert ".xlsx" in chosen.get_attribute("accept")
    chosen.set_input_files(empty)
    expect(dialog.get_by_role("alert")).to_be_visible()
    expect(dialog.get_by_role("button", name="Insert")).to_be_disabled()
    assert page.locator("[id='-load_x']").input_value() == before
    chosen.set_input_files(file)
    expect(dialog.locator("tbody tr").first).to_contain_text("1.5")
    dialog.get_by_role("button", name="Insert 2 rows").click()
    expect(page.locator("[id='-crank_angle']")).to_have_value("[0, 90] deg")
    expect(page.locator("[id='-load_x']")).to_have_value("[1.5, -2.5] kN")
    expect(page.locator("[id='-load_y']")).to_have_value("[0.5, 0.25] kN")
    refused = [fault for fault in watched.faults() if "/tables" not in str(fault) and "422" not in str(fault)]
    assert refused == []


@pytest.mark.slow
def test_a_list_of_quantities_and_relations_is_edited_by_keyboard_and_saved(watched, http):
    place = from_example(http, "torsional_vibration/1")
    page = watched.page
    page.set_viewport_size({"width": 390, "height": 800})
    watched.open(place)
    page.locator("#torsional_vibration-inertias").scroll_into_view_if_needed()
    page.get_by_role("button", name="Edit the items of inertias").press("Enter")
    dialog = page.get_by_role("dialog", name="Items of inertias")
    expect(dialog.get_by_label("Item 1", exact=True)).to_have_value("0.012 kg*m**2")
    expect(dialog.get_by_label("Item 1", exact=True)).to_be_focused()
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    box = dialog.bounding_box()
    assert box["x"] >= 0
    assert box["x"] + box["width"] <= 390
    page.keyboard.press("Enter")
    expect(dialog.get_by_label("Item 2", exact=True)).to_be_focused()
    page.keyboard.type("= 2 * 6000 kg*mm**2")
    dialog.get_by_role("button", name="Remove item 3").click()
    dialog.get_by_role("button", name="Insert").click()
    field = page.locator("#torsional_vibration-inertias")
    expect(field).to_have_value('["0.012 kg*m**2","= 2 * 6000 kg*mm**2","0.35 kg*m**2","0.1 kg*m**2"]')
    page.get_by_role("button", name=re.compile("Save as revision")).click()
    expect(page.locator(".page-head")).to_contain_text("revision 2")
    inputs = http.get(f"{API}{place}").json()["steps"]["torsional_vibration"]["inputs"]
    assert inputs["inertias"] == ["0.012 kg*m**2", "= 2 * 6000 kg*mm**2", "0.35 kg*m**2", "0.1 kg*m**2"]
    page.get_by_role("button", name="Edit the items of inertias").click()
    dialog.get_by_label("Item 2", exact=True).fill("0.02 kg*m**2")
    dialog.get_by_role("button", name="Insert").click()
    expect(field).to_have_value("[0.012,0.02,0.35,0.1] kg*m**2")
    assert watched.faults() == []


def test_items_and_texts_become_each_other(watched):
    watched.open("/worksheets/new")  # a page that draws no pictures of designs
    script = (
        "async (texts) => { const m = await import('/static/lists/items.js'); return texts.map(m.itemsOf) }"
    )
    texts = ["", "[1, 2] mm", '["= a", 3, {"value": 4, "unit": "mm"}]', "= load.crank_angle", "[[1], [2]] mm"]
    assert watched.page.evaluate(script, texts) == [
        [],
        ["1 mm", "2 mm"],
        ["= a", "3", "4 mm"],
        ["= load.crank_angle"],
        None,
    ]
    script = (
        "async (lists) => { const m = await import('/static/lists/items.js'); return lists.map(m.textOf) }"
    )
    lists = [["1 mm", " 2e1 mm", ""], ["1", "2"], ["1 mm", "2 in"], ["= a", "3"], []]
    assert watched.page.evaluate(script, lists) == ["[1,20] mm", "[1,2]", '["1 mm","2 in"]', '["= a",3]', ""]


@pytest.fixture
def throw(http):
    """The path of a design with a shell, and with a crank throw that nothing sets yet."""
    shell = {
        "id": "plain_bearing",
        "version": 1,
        "parameters": {**BUSH, "inner_diameter": "48 mm", "width": "18 mm"},
    }
    document = {"name": "throw", "models": {"throw": {"id": "crank_throw", "version": 1}, "shell": shell}}
    response = http.post(f"{API}/designs", json=document, headers={"Prefer": "wait=30"})
    assert response.status_code in (201, 202), response.text
    return f"/designs/{response.json()['id']}"


@pytest.mark.slow
def test_analyses_and_iterations_are_added_changed_and_removed_without_json(watched, http, throw):
    page = watched.page
    page.set_viewport_size({"width": 390, "height": 800})
    watched.open(throw)
    page.get_by_text("Analyses of the models").click()
    new = page.get_by_role("group", name="New analysis of throw")
    new.get_by_label("Kind").select_option("bending")
    new.get_by_label("Level").select_option("coarse")
    new.get_by_role("textbox", name="Load").fill("2 N*m")
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    new.get_by_role("button", name="Add analysis").click()
    expect(page.locator(".page-head")).to_contain_text("revision 2")
    analysis = http.get(f"{API}{throw}").json()["models"]["throw"]["analyses"]["bending"]
    assert (analysis["level"], analysis["load"]) == ("coarse", "2 N*m")

    page.get_by_text("Analyses of the models").click()
    old = page.get_by_role("group", name="throw.bending")
    expect(old.get_by_role("textbox", name="Load")).to_have_value("2 N*m")
    old.get_by_label("Level").select_option("")
    old.get_by_label("or largest error").fill("0.02")
    old.get_by_role("button", name="Change").click()
    expect(page.locator(".page-head")).to_contain_text("revision 3")
    analysis = http.get(f"{API}{throw}").json()["models"]["throw"]["analyses"]["bending"]
    assert (analysis["level"], analysis["tolerance"]) == (None, 0.02)

    page.get_by_text("Iterations (0)").click()
    new = page.get_by_role("group", name="New iteration")
    new.get_by_label("Through").fill("shell.mass")
    new.get_by_label("Start").fill("0.1 kg")
    new.get_by_label("Most rounds").fill("12")
    new.get_by_role("button", name="Add iteration").click()
    expect(page.locator(".page-head")).to_contain_text("revision 4")
    iteration = {"through": "shell.mass", "start": "0.1 kg", "tolerance": 1e-4, "limit": 12}
    assert http.get(f"{API}{throw}").json()["iterations"] == [iteration]

    page.get_by_text("Iterations (1)").click()
    page.get_by_role("group", name="Iteration 1").get_by_role("button", name="Remove").click()
    expect(page.locator(".page-head")).to_contain_text("revision 5")
    page.get_by_text("Analyses of the models").click()
    page.get_by_role("group", name="throw.bending").get_by_role("button", name="Remove").click()
    expect(page.locator(".page-head")).to_contain_text("revision 6")
    design = http.get(f"{API}{throw}").json()
    assert design["iterations"] == []
    assert "analyses" not in design["models"]["throw"]
    assert watched.faults() == []


@pytest.mark.slow
@pytest.mark.parametrize(
    "typed",
    [
        {"declare": "analysis", "model": "throw", "kind": "torsion", "load": "2 mm"},
        {"declare": "analysis", "model": "throw", "kind": "torsion", "tolerance": "small"},
        {"declare": "analysis", "model": "nobody", "kind": "torsion"},
        {"declare": "analysis"},
        {"declare": "iteration", "through": "throw.mass", "start": "3 kg", "limit": "many"},
        {"declare": "iteration", "through": "throw.mass", "start": "3 kg", "tolerance": "7"},
        {"declare": "iteration"},
    ],
)
@pytest.mark.sampled(3)
def test_a_form_that_is_wrong_says_so_and_saves_nothing(http, throw, typed):
    answer = http.post(f"{throw}/blocks", data={"revision": "1", **typed})
    assert answer.status_code == 422
    assert 'role="alert"' in answer.text
    assert http.get(f"{API}{throw}").json()["revision"] == 1


@pytest.mark.slow
def test_a_refused_analysis_keeps_what_was_typed_with_the_fault_beside_it(watched, http, throw):
    page = watched.page
    watched.open(throw)
    page.get_by_text("Analyses of the models").click()
    new = page.get_by_role("group", name="New analysis of throw")
    new.get_by_label("Kind").select_option("torsion")
    new.get_by_label("or largest error").fill("0.01")
    new.get_by_role("textbox", name="Load").fill("2 mm")
    new.get_by_role("button", name="Add analysis").click()
    expect(page.get_by_role("alert").first).to_contain_text("Nothing was saved: load of the analysis")
    again = page.get_by_role("group", name="New analysis of throw")
    expect(again.get_by_role("textbox", name="Load")).to_have_value("2 mm")
    expect(again.get_by_role("textbox", name="Load")).to_have_attribute("aria-invalid", "true")
    expect(again.get_by_label("or largest error")).to_have_value("0.01")
    expect(again.get_by_label("Kind")).to_have_value("torsion")
    expect(again.locator(".field-error")).to_contain_text("measures a length")
    again.get_by_role("textbox", name="Load").fill("2 N*m")
    again.get_by_role("button", name="Add analysis").click()
    expect(page.locator(".page-head")).to_contain_text("revision 2")
    options = http.get(f"{API}{throw}").json()["models"]["throw"]["analyses"]["torsion"]
    assert (options["tolerance"], options["load"]) == (0.01, "2 N*m")


@pytest.mark.parametrize(
    ("typed", "field"),
    [
        ({"declare": "iteration", "place": "", "through": "shell.mass", "start": "3 mm"}, "start"),
        ({"declare": "iteration", "place": "", "through": "nobody.mass", "start": "3 kg"}, "through"),
        (
            {"declare": "iteration", "place": "", "through": "shell.mass", "start": "3 kg", "limit": "many"},
            "limit",
        ),
        ({"add": "parameter", "name": "gap", "value": "3 parsec kg"}, "value"),
    ],
)
@pytest.mark.sampled(2)
def test_a_refused_part_keeps_what_was_typed(http, throw, typed, field):
    answer = http.post(f"{throw}/blocks", data={"revision": "1", **typed})
    assert answer.status_code == 422
    for name in typed.keys() & {"through", "start", "limit", "value"}:
        control = re.search(rf'<input name="{name}"[^>]* value="{re.escape(typed[name])}"[^>]*>', answer.text)
        assert control, name
        assert ('aria-invalid="true"' in control[0]) == (name == field)
    beside = re.search(
        rf'<input name="{field}"[^>]*aria-invalid="true"[^>]*>\s*<span class="field-error"', answer.text
    )
    assert beside
    assert f"{field}</a> of the {typed.get('declare') or typed.get('add')} was not accepted" in answer.text
