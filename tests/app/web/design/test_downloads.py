"""Downloads in Chromium: the page waits for a file, and never saves an error as a file."""

import json
import re
from pathlib import Path

import pytest
from bare_shells import BUSH
from patience import patient, until
from playwright.sync_api import expect
from serving import API

from cad.file_kinds import BY_PART, MEDIA_TYPES

PATIENCE = patient(60.0) * 1000  # ms
SHELL = {"id": "plain_bearing", "version": 1, "parameters": {**BUSH, "inner_diameter": "37.5 mm"}}
PROBLEM = {
    "type": "/problems/geometry",
    "title": "Geometry",
    "status": 422,
    "detail": "no room for a title block",
}


def design(http, name):
    body = {"name": name, "models": {"shell": SHELL}}
    answer = http.post(f"{API}/designs", json=body, headers={"Prefer": "wait=60", "Accept": "*/*"})
    assert answer.status_code == 201, answer.text
    return answer.json()["id"]


def link(page, kind):
    return page.get_by_role("link", name=kind, exact=True)


@pytest.mark.slow
def test_a_drawing_that_is_not_made_yet_is_waited_for(watched, http):
    page = watched.page
    page.goto(f"{watched.url}/designs/{design(http, 'Käfig 2')}")
    with page.expect_download(timeout=PATIENCE) as download:
        link(page, "DXF").click()
    assert download.value.suggested_filename == "Käfig_2_shell_r1.dxf"
    assert Path(download.value.path()).read_text().startswith("  0\nSECTION")
    expect(page.locator("[data-download-status]")).to_be_empty()


def test_the_step_file_is_the_first_of_the_downloads(http):
    page = http.get(f"/designs/{design(http, 'first')}").text
    links = page.partition('aria-label="Downloads"')[2].partition("</p>")[0]
    offered = re.findall(r"data-download>([^<]+)</a>", links)
    assert offered[:2] == ["STEP", "STEP with checks"]
    assert len(offered) == len({*offered}) == len(MEDIA_TYPES) - 1  # all kinds but the picture


def test_the_parts_of_an_assembly_have_files_of_their_own(http):
    """The page offers the kinds that can hold one part, for each part; a single part has no such list."""
    assert "Files of single parts" not in http.get(f"/designs/{design(http, 'one')}").text
    pair = {"id": "plain_bearing", "version": 1, "parameters": {"inner_diameter": "37.5 mm"}}
    body = {"name": "pair", "models": {"shell": pair}}
    made = http.post(f"{API}/designs", json=body, headers={"Prefer": "wait=60", "Accept": "*/*"}).json()
    page = http.get(f"/designs/{made['id']}").text
    links = re.findall(r'href="([^"]+[?]part=[^"]+)"', page)
    asked = [re.search(r"model\.(.+)[?]part=(.+)", one).groups() for one in links]
    parts = list(dict.fromkeys(part for _, part in asked))
    assert parts == ["lower_back", "lower_lining", "upper_back", "upper_lining"]
    assert asked == [(kind, part) for part in parts for kind in BY_PART]
    (stl,) = [one for one in links if one.endswith(f"model.stl?part={parts[0]}")]
    answer = http.get(stl, headers={"Prefer": "wait=60"})
    assert answer.status_code == 200, answer.text
    assert f"_{parts[0]}.stl" in answer.headers["content-disposition"]
    (step,) = [one for one in links if one.endswith(f"model.step?part={parts[0]}")]
    answer = http.get(step, headers={"Prefer": "wait=60"})
    assert f"_{parts[0]}.step" in answer.headers["content-disposition"]
    assert answer.content.count(b"= PRODUCT(") == 1
    assert f"PRODUCT('pair_shell_{parts[0]}'".encode() in answer.content
    assert b"mass " in answer.content
    headers = {"Content-Type": "model/step", "Prefer": "wait=60"}
    verified = http.post(f"{API}/verify", content=answer.content, headers=headers).json()
    assert (verified["kind"], verified["intact"]) == ("step", True)


@pytest.mark.slow
def test_a_job_is_followed_and_its_answer_is_not_saved(watched, http):
    """202 twice, as of a queue that is long; the page shows how far the job is, and saves the file alone."""
    page, asked, id = watched.page, [], design(http, "slow")
    path = f"{API}/designs/{id}/models/shell/model.stl"
    until(lambda: http.get(path, headers={"Prefer": "wait=60"}).status_code == 200)  # a busy machine says 202

    def slow(route):
        asked.append(route.request.url)
        headers = {"Location": f"{API}/jobs/made-up", "Content-Type": "application/json"}
        if len(asked) < 3:
            route.fulfill(status=202, headers=headers, body='{"job": "made-up"}')
        else:
            route.continue_()

    def events(route):
        body = 'event: progress\ndata: {"progress": 0.5, "text": "drawing"}\n\nevent: done\ndata: {}\n\n'
        route.fulfill(headers={"Content-Type": "text/event-stream"}, body=body)

    page.route("**/models/shell/model.stl", slow)
    page.route("**/jobs/made-up/events", events)
    page.route("**/jobs/made-up", lambda route: route.fulfill(body=json.dumps({"state": "done"})))
    page.goto(f"{watched.url}/designs/{id}")
    with page.expect_download(timeout=PATIENCE) as download:
        link(page, "STL").click()
    assert download.value.suggested_filename == "slow_shell_r1.stl"
    assert not Path(download.value.path()).read_bytes().startswith(b"{")
    assert len(asked) == 3


@pytest.mark.slow
def test_why_a_file_cannot_be_made_is_said_and_nothing_is_saved(watched, http):
    page, saved = watched.page, []
    page.on("download", lambda file: saved.append(file))
    refusal = json.dumps(PROBLEM)
    page.route(
        "**/models/shell/model.dxf",
        lambda route: route.fulfill(status=422, content_type="application/problem+json", body=refusal),
    )
    page.goto(f"{watched.url}/designs/{design(http, 'refused')}")
    link(page, "DXF").click()
    expect(page.locator("[data-download-status]")).to_contain_text("no room for a title block")
    assert saved == []


@pytest.mark.slow
def test_fields_of_a_title_block_are_typed_before_a_download(watched, http):
    page = watched.page
    page.goto(f"{watched.url}/designs/{design(http, 'typed')}")
    page.get_by_text("Title block of a drawing").click()
    page.get_by_label("Identification number").fill("4711-08")
    page.get_by_label("Created by").fill("Bo & Co")
    with page.expect_download(timeout=PATIENCE) as download:
        page.locator("[data-buttons]").get_by_role("button", name="DXF").click()
    assert download.value.suggested_filename == "typed_shell_r1.dxf"
    lines = Path(download.value.path()).read_text().splitlines()
    assert "4711-08" in lines
    assert "Bo & Co" in lines
    page.get_by_label("Document status").fill("released")
    page.locator("[data-buttons]").get_by_role("button", name="SVG").click()
    status = page.locator("[data-buttons] [data-download-status]")
    expect(status).to_contain_text("approval", timeout=PATIENCE)


@pytest.mark.slow
def test_the_page_of_a_model_shows_its_drawing(watched):
    page = watched.page
    page.goto(f"{watched.url}/models/plain_bearing/1")
    picture = page.get_by_alt_text("Technical drawing of the part", exact=False)
    picture.scroll_into_view_if_needed(timeout=PATIENCE)
    page.wait_for_function(
        "picture => picture.complete && picture.naturalWidth > 0",
        arg=picture.element_handle(),
        timeout=PATIENCE,
    )
    section = page.locator(".technical-drawing")
    with page.expect_download(timeout=PATIENCE) as download:
        section.get_by_role("link", name="DXF").click()
    assert download.value.suggested_filename == "plain_bearing_v1.dxf"
