"""Names with direction controls are isolated on pages and cleaned in titles and reports."""

import io
import re

import pypdf
import pytest
from serving import API, created, patched

from app.presentation.bidi import balanced, bare

NAME = "front\u202egnp.exe \u2066main\u2069\u2069 <script>alert('1')</script> \"quoted\" & more\u2028line"
NOTE = "why \u202b<b>not</b>\u2069"
CONTROLS = re.compile("[\u202a-\u202e\u2066-\u2069\u200e\u200f\u061c\u2028\u2029\x85]")
ISOLATED = re.compile("<bdi>[^<]*</bdi>")
IN_CONTROL = re.compile(r"<(?:input|option)[^>]*>")  # a control isolates by itself


@pytest.fixture(scope="module")
def design(http):
    parameters = {"inner_diameter": "50 mm"}
    document = {"name": NAME, "model": {"id": "ball_bearing", "version": 1, "parameters": parameters}}
    return patched(http, created(http, {**document, "note": NOTE}), {"name": f"{NAME}2", "note": NOTE})


PAGES = (
    "/",
    "/designs",
    "/designs/{id}",
    "/designs/{id}/revisions/1",
    "/designs/{id}/revisions/2?with=1",
    "/designs/{id}/explain/inner_diameter",
    "/designs/{id}/report",
)


def page_of(http, path, design):
    response = http.get(path.format(id=design["id"]), headers={"Accept": "text/html"}, follow_redirects=True)
    assert response.status_code == 200, response.text[:500]
    return response.text


@pytest.mark.parametrize("path", PAGES)
@pytest.mark.sampled(3)
def test_names_on_pages_turn_nothing_outside_their_element(http, design, path):
    page = page_of(http, path, design)
    assert "gnp.exe" in page
    assert any("gnp.exe" in name for name in ISOLATED.findall(page))
    for name in ISOLATED.findall(page):
        assert name.count("\u2069") <= sum(map(name.count, "\u2066\u2067\u2068"))
        assert "\u2028" not in name
    assert not CONTROLS.search(IN_CONTROL.sub("", ISOLATED.sub("", page)))


@pytest.mark.parametrize("path", PAGES)
@pytest.mark.sampled(3)
def test_names_are_no_markup(http, design, path):
    page = page_of(http, path, design)
    assert "<script>alert" not in page
    assert "&lt;script&gt;" in page
    assert "<b>not" not in page


@pytest.mark.slow
@pytest.mark.parametrize("path", [path for path in PAGES if "{id}" in path])
def test_titles_are_bare(http, design, path):
    title = re.search("<title>(.*?)</title>", page_of(http, path, design), re.DOTALL)[1]
    assert "bdi" not in title
    assert "gnp.exe" in title
    assert not CONTROLS.search(title)


def test_notes_are_isolated(http, design):
    for path in ("/designs/{id}", "/designs/{id}/revisions/2", "/designs/{id}/report"):
        notes = [name for name in ISOLATED.findall(page_of(http, path, design)) if "why" in name]
        assert notes, path


def test_paper_is_bare(http, design):
    response = http.get(f"{API}/designs/{design['id']}/report.pdf", headers={"Prefer": "wait=60"})
    assert response.status_code == 200
    paper = pypdf.PdfReader(io.BytesIO(response.content))
    text = " ".join(page.extract_text() for page in paper.pages)
    assert "gnp.exe" in text.replace("\u200b", "")
    assert not CONTROLS.search(text + str(paper.metadata.title))


def test_what_is_wrong_with_a_name_is_isolated(http):
    response = http.get("/designs/none\u202egnp", headers={"Accept": "text/html"})
    assert response.status_code == 404
    assert not CONTROLS.search(ISOLATED.sub("", response.text))


def test_the_interface_keeps_the_name_as_given(http, design):
    assert http.get(f"{API}/designs/{design['id']}").json()["name"] == f"{NAME}2"


def test_balanced_ends_what_it_began_only():
    assert balanced("\u2069a\u2066b\u2069\u2069c") == "a\u2066b\u2069c"
    assert balanced("\u202ea\u202c\u202c") == "\u202ea\u202c\u202c"  # inside an isolation these reach nothing
    assert balanced("a\u2029b") == "a b"


def test_bare_takes_every_control_and_nothing_else():
    assert bare("\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069\u200e\u200f\u061c") == ""
    assert (
        bare("שלום, Lager \u2028\N{GREEK SMALL LETTER MU}\u200d")
        == "שלום, Lager  \N{GREEK SMALL LETTER MU}\u200d"
    )
