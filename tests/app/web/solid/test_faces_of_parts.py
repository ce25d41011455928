"""In a browser, a face of a part leads to its parameter, and a parameter to its faces, also by keyboard."""

import pytest
from browsing import created
from playwright.sync_api import expect
from serving import API

PANEL = "[data-face-panel]"
COLOURS = """() => {
  const { data } = document.querySelector(".solid .js-plotly-plot");
  return data.map(({ vertexcolor }) => vertexcolor.join(" "));
}"""


@pytest.fixture
def shell(http):
    """The address of a design whose shell has faces with several parameters."""
    return created(http, "shell")


def opened(watched, place):
    """The list of the parameters of a design's faces, unfolded."""
    watched.open(place)
    watched.page.locator(".solid").scroll_into_view_if_needed()  # it is drawn when it comes into view
    faces = watched.page.locator("[data-faces]")
    expect(faces).to_be_visible()
    faces.locator("summary").focus()
    watched.page.keyboard.press("Enter")
    return faces


@pytest.mark.parametrize("width", [pytest.param(1440, marks=pytest.mark.slow), 390], ids=["wide", "narrow"])
def test_the_list_shows_by_keyboard_where_a_dimension_comes_from(watched, http, shell, width):
    page = watched.page
    page.set_viewport_size({"width": width, "height": 900})
    faces = opened(watched, shell)
    before = page.evaluate(COLOURS)
    bore = faces.get_by_role("button", name="inner diameter", exact=True)
    bore.focus()
    page.keyboard.press("Enter")
    expect(bore).to_have_attribute("aria-pressed", "true")
    article = faces.locator('article[data-face="model.inner_diameter"]')
    explained = http.get(f"{API}{shell}/explain/model.inner_diameter").json()
    expect(article.get_by_role("heading")).to_contain_text("Inner diameter = ")
    expect(article.locator("dt")).to_have_text(["Relation", "Formula", "Inputs", "Error", "Criteria"])
    expect(article.locator("dd code").first).to_have_text(explained["relation"])
    judged = article.locator("dd").nth(4).get_by_role("link")
    assert judged.count() == min(6, len(explained["criteria"])) > 0
    link = article.get_by_role("link", name="Every step and the sensitivities")
    assert link.get_attribute("href").endswith("/explain/model.inner_diameter")
    assert page.evaluate(COLOURS) != before
    wide = page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
    assert wide <= 0
    page.keyboard.press("Enter")
    expect(faces.locator("article")).to_have_count(0)
    assert page.evaluate(COLOURS) == before
    assert watched.faults() == []


SEVERAL = """() => {
  const marks = document.querySelector("[data-faces]").drawn.bodies.flatMap((body) => body.marks);
  return marks.find((own) => own.length > 1);
}"""
CLICK = """([parameters, moved]) => {
  const figure = document.querySelector(".solid .js-plotly-plot");
  const { bodies } = document.querySelector("[data-faces]").drawn;
  const wanted = ({ marks }) => marks.findIndex((own) => own.join() === parameters.join());
  const curveNumber = bodies.findIndex((body) => wanted(body) >= 0), body = bodies[curveNumber];
  const pointNumber = wanted(body) + 2 * body.marks.length;
  figure.acts.plotly_hover({ points: [{ curveNumber, pointNumber }] });
  const pointer = (kind, clientX) => figure.dispatchEvent(new PointerEvent(kind, { clientX, clientY: 9 }));
  pointer("pointerdown", 5);
  pointer("pointerup", 5 + moved);
}"""
"""Click, as Plotly reports it, on a corner of the third instance of a face that carries these parameters."""


def test_a_click_shows_the_parameter_of_a_face_and_offers_its_others(watched, shell):
    page = watched.page
    watched.open(shell)
    faces = page.locator("[data-faces]")
    expect(faces).to_be_visible()
    expect(faces.locator(PANEL)).to_be_hidden()
    carried = page.evaluate(SEVERAL)
    page.evaluate(CLICK, [carried, 40])  # a drag, which turns the part
    page.wait_for_timeout(300)
    expect(faces.locator("[aria-pressed=true]")).to_have_count(0)
    page.evaluate(CLICK, [carried, 1])
    expect(faces.locator("article")).to_have_attribute("data-face", f"model.{carried[0]}")
    expect(faces.locator("[data-face-list] [aria-pressed=true]")).to_have_text(carried[0].replace("_", " "))
    others = faces.locator(PANEL).locator("[data-parameter]")
    expect(others).to_have_text([name.replace("_", " ") for name in carried[1:]])
    others.first.click()
    expect(faces.locator("article")).to_have_attribute("data-face", f"model.{carried[1]}")
    page.evaluate(CLICK, [[], 0])
    expect(faces.locator(PANEL)).to_have_text("This face carries no parameter of its own.")
    expect(faces.locator("[aria-pressed=true]")).to_have_count(0)
    assert watched.faults() == []


@pytest.mark.slow
@pytest.mark.usefixtures("plotted")
def test_a_click_on_a_face_shows_its_parameters(watched, shell):
    """On the picture as Plotly draws it: some points along a line through its middle are on marked faces."""
    page = watched.page
    page.set_viewport_size({"width": 1440, "height": 900})
    watched.open(shell)
    faces = page.locator("[data-faces]")
    expect(faces).to_be_visible()
    figure = page.locator(".solid .js-plotly-plot")
    page.wait_for_timeout(1000)
    for share in (0.5, 0.6, 0.4, 0.7, 0.3):
        figure.scroll_into_view_if_needed()
        box = figure.bounding_box()
        x, y = box["x"] + share * box["width"], box["y"] + 0.5 * box["height"]
        page.mouse.move(x - 2, y)
        page.wait_for_timeout(300)
        page.mouse.move(x, y)
        page.wait_for_timeout(300)
        page.mouse.down()
        page.wait_for_timeout(100)
        page.mouse.up()
        page.wait_for_timeout(500)
        if faces.locator("[aria-pressed=true]").count():
            break
    name = faces.locator("[data-face-list] [aria-pressed=true]").get_attribute("data-parameter")
    expect(faces.locator("article")).to_have_attribute("data-face", f"model.{name}")
    assert watched.faults() == []


def test_an_answer_that_fails_is_said(watched, shell):
    page = watched.page
    page.route("**/faces/model.*", lambda route: route.fulfill(status=503, body=""))
    faces = opened(watched, shell)
    faces.get_by_role("button", name="width", exact=True).click()
    expect(faces.get_by_role("alert")).to_contain_text("could not be loaded: answer 503")
    assert all(status == 503 for _, status in watched.failed)
