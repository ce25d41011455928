"""The page that finds a bearing: the paper's values are answered, refused by name, and saved."""

import re

import pytest
from patience import patient, until

PAGE = "/find-bearing"


def ended(http, answer):
    """The page behind an answer once its calculation has ended; a job keeps its page in its address."""

    def page():
        shown = http.get(answer.url, follow_redirects=True)
        return None if is_calculating(shown) else shown

    return until(page, seconds=patient(60)) if is_calculating(answer) else answer


def is_calculating(page):
    """Whether a page shows the progress of its answer; the page of a design shows that of its solids."""
    return page.url.path == PAGE and "data-progress " in page.text


def shown(http, **typed):
    """The page of a request once its calculation has ended."""
    return ended(http, http.get(PAGE, params={"load": "25 kN", **typed}, follow_redirects=True))


def test_the_front_page_links_to_the_empty_form(http):
    assert f'href="{PAGE}"' in http.get("/").text
    page = http.get(PAGE).text
    assert 'name="film" value="3 um"' in page
    assert "Requirement" not in page


@pytest.mark.slow
def test_the_bearing_of_the_paper_is_found_and_saved(http):
    page = shown(http)
    assert page.status_code == 200
    assert "mass_conserving" in page.text
    hidden = dict(re.findall(r'<input type="hidden" name="([^"]+)" value="([^"]*)">', page.text))
    saved = ended(http, http.post(PAGE, data=hidden, follow_redirects=True))
    design = http.get(f"/api/v1{saved.url.path}").json()
    width = float(design["steps"]["film"]["inputs"]["bearing_width"].removesuffix(" mm"))
    assert (2 * width) % 1 == 0
    film = next(one for one in design["results"]["criteria"] if one["name"].endswith("thickness_least"))
    assert film["verdict"] == "met"


@pytest.mark.parametrize(
    ("typed", "words"),
    [
        pytest.param({"film": "40 um"}, "cannot be met", marks=pytest.mark.slow),
        ({"width_low": "40 mm", "width_high": "15 mm"}, "first bound must be below"),
        ({"film": "3"}, "unit"),
    ],
)
def test_a_request_without_an_answer_says_why(http, typed, words):
    assert words in shown(http, **typed).text
