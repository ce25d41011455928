"""The front page begins with what a user can do; the library lists each template once."""

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import expect

from app.catalogue.schemas.templates import TemplateSummary
from app.web.home.routes import each_once

SQUARE = '<svg xmlns="http://www.w3.org/2000/svg" width="4" height="4"/>'

LONGEST = 5000  # height of the page [pixels]


def version(id: str, number: int, *, latest: bool) -> TemplateSummary:
    return TemplateSummary(id=id, version=number, title=id, summary="", status="released", latest=latest)


def test_each_template_is_listed_once_in_its_latest_version_found():
    items = [version("a", 1, latest=False), version("a", 2, latest=True), version("a", 3, latest=False)]
    found = [version("b", 1, latest=False), version("b", 2, latest=False)]
    assert [(item.id, item.version) for item in each_once(items + found)] == [("a", 2), ("b", 2)]
    assert each_once([]) == []


@pytest.mark.slow
@pytest.mark.parametrize("width", [1440, 390])
def test_the_front_page_begins_with_what_one_can_do(watched, width):
    page = watched.page
    page.set_viewport_size({"width": width, "height": 844})
    watched.open("/")
    order = page.locator("main > section").evaluate_all(
        "all => all.map((one) => one.getAttribute('aria-labelledby'))"
    )
    assert order == ["start", "designs", "examples", "templates", "models"]
    codes = page.locator("section[aria-labelledby=templates] .card code").all_inner_texts()
    ids = [code.split()[0] for code in codes]
    assert ids
    assert len(ids) == len(set(ids))
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert page.evaluate("document.documentElement.scrollHeight") < LONGEST
    page.get_by_role("link", name="New design").click()
    expect(page.locator(".new-design input[name=name]")).to_be_visible()
    assert Axe().run(page, options={"resultTypes": ["violations"]}).response["violations"] == []
    assert watched.faults() == []


@pytest.mark.slow
def test_a_picture_that_is_not_drawn_yet_is_requested_again(watched):
    page, answers = watched.page, [404, 404, 200]

    def answer(route):
        status = answers.pop(0)
        route.fulfill(status=status, content_type="image/svg+xml", body=SQUARE if status == 200 else "")

    page.route("**/models/plain_bearing/versions/1/picture", answer)
    watched.open("/")
    image = page.locator("img[src*=plain_bearing]")
    image.scroll_into_view_if_needed()
    expect(image).to_have_class("missing")
    expect(image).to_have_class("")
    assert image.evaluate("(one) => one.naturalWidth") == 4
    assert answers == []
