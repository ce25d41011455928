"""A team imports a model on its page, without scripts."""

import sys
from pathlib import Path

import pytest
from playwright.sync_api import expect

sys.path.insert(0, str(Path(__file__).parents[2] / "imported_models"))

from freecad_files import bush, needs_freecad
from serving import API, heard


def sent(page, id, content, file):
    page.get_by_label("Name", exact=True).fill(id)
    page.get_by_label("File").set_input_files({"name": file, "mimeType": "", "buffer": content})
    page.get_by_role("button", name="Import the model").click()


@pytest.mark.slow
@needs_freecad
def test_a_file_of_freecad_is_brought_by_a_form_alone(plain):
    page = plain.page
    plain.open("/models/import")
    sent(page, "bush_of_page", bush(), "bush.FCStd")
    expect(page.get_by_role("heading", name="bush", exact=True)).to_be_visible(timeout=30_000)
    expect(page.get_by_role("note")).to_contain_text("Trust lower: FreeCAD drew the shape")
    expect(page.get_by_label("bore", exact=False).first).to_be_visible()
    expect(page).to_have_url(f"{plain.url}/models/bush_of_page/1")


def test_a_file_that_is_not_taken_is_explained_beside_the_form(plain):
    plain.open("/models/import")
    sent(plain.page, "wrong", b"no model", "wrong.txt")
    expect(plain.page.get_by_role("alert")).to_contain_text("send a FreeCAD file (.FCStd)")
    expect(plain.page.get_by_label("Name", exact=True)).to_have_value("wrong")


def test_a_form_without_a_file_is_explained(http):
    answer = http.post("/models/import", data={"id": "nothing"})
    assert answer.status_code == 422
    assert "choose a file" in answer.text


def test_a_job_of_another_kind_leads_to_the_form(http):
    shape = {"parameters": {"inner_diameter": "30 mm"}}
    path = f"{API}/models/thrust_washer/versions/1/build"
    job = http.post(path, json=shape, headers={"Prefer": "wait=0"}).headers["Location"].rpartition("/")[2]
    with http.stream("GET", f"{API}/jobs/{job}/events") as stream:
        assert any(event == "done" for event, _ in heard(stream))
    for page in ("/models/import", "/worksheets/import"):
        answer = http.get(page, params={"job": job})
        assert answer.status_code == 200
        assert f'action="{page}"' in answer.text
