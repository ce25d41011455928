"""The pages of an import from Mathcad, without scripts and with them."""

import sys
from pathlib import Path

import pytest
from playwright.sync_api import expect

sys.path.insert(0, str(Path(__file__).parents[2] / "worksheet_import"))

from mathcad_files import apply, call, define, math, name, prime, raw, real, scale, shown, united

SHEET = prime(
    math(define("x", scale(500, "mm"))),
    math(define("y", apply("mult", real(2), name("x"))), united(real(1), meter=1)),
    math(shown(apply("mult", real(3), name("x"))), united(real(1), meter=1)),
    math(define("z", call("rnorm", real(1), real(0), real(1)))),
    math(define("w", apply("mult", real(2), name("z")))),
    raw("<plot/>"),
)


def sent(page, id, content=SHEET, file="beam <b>.mcdx"):
    page.get_by_label("Name", exact=True).fill(id)
    page.get_by_label("File").set_input_files({"name": file, "mimeType": "", "buffer": content})
    page.get_by_role("button", name="Import the sheet").click()


def test_a_sheet_is_imported_by_a_form_alone(plain):
    page = plain.page
    plain.open("/worksheets/import")
    sent(page, "import_by_form")
    expect(page.get_by_role("heading", name="Import of")).to_be_visible(timeout=30_000)
    expect(page.locator(".import-counts")).to_contain_text("verified")
    rows = page.locator(".import-regions tbody tr")
    expect(rows).to_have_count(6)
    expect(rows.nth(2)).to_contain_text("differs")
    expect(rows.nth(2)).to_contain_text("1.5 m")
    expect(rows.nth(3)).to_contain_text("random numbers")
    expect(rows.nth(4).get_by_role("link", name="3")).to_have_attribute("href", "#region-3")
    expect(page.get_by_role("status")).to_contain_text("3 regions prevent a release")
    page.get_by_role("link", name="Open the draft").click()
    expect(page).to_have_url(f"{plain.url}/worksheets/import_by_form")


@pytest.mark.slow
def test_a_file_that_is_not_taken_is_explained_beside_the_form(plain):
    page = plain.page
    plain.open("/worksheets/import")
    sent(page, "import_wrong", b"no sheet")
    expect(page.get_by_role("alert")).to_contain_text("is not XML", timeout=30_000)
    expect(page.get_by_label("Name", exact=True)).to_have_value("import_wrong")


@pytest.mark.parametrize("id", ["oil_film", "check"])
def test_an_id_that_is_not_free_is_explained_at_once(plain, id):
    plain.open("/worksheets/import")
    sent(plain.page, id)
    expect(plain.page.get_by_role("alert")).to_contain_text("choose another")


def test_a_form_without_a_file_is_explained(http):
    answer = http.post("/worksheets/import", data={"id": "import_nothing"})
    assert answer.status_code == 422
    assert "choose a file" in answer.text
