"""The engine of the gallery as a page, without its finite elements: each bearing's film is met or not met."""

import pytest
from browsing import settled
from equal_tables import assert_equal_in_print, assert_equal_on_page_and_in_files
from playwright.sync_api import expect
from serving import API
from test_true_pages import assert_true

from app.designs.gallery.gallery import GALLERY

pytestmark = pytest.mark.slow  # ten films are marched

LONG = 600_000  # for the films to be calculated [ms]
OF_FILMS = {
    "parameters": ("bore", "pin_diameter", "pitch", "bearing"),
    "steps": ("engine", "film"),
    "models": ("shell",),
}


def films():
    """The document of the gallery with engine, film and shell alone."""
    document = GALLERY["engine"].document
    parts = {part: {name: document[part][name] for name in names} for part, names in OF_FILMS.items()}
    return {name: document[name] for name in ("name", "variants")} | parts


def test_every_bearing_of_the_engine_is_decided_on_its_page(watched, http, tmp_path):
    answer = http.post(f"{API}/designs", json=films())
    assert answer.status_code in (201, 202), answer.text
    place = f"/designs/{answer.json()['id']}"
    design = settled(http, place, seconds=LONG / 1000)
    assert design["state"] == "current", design.get("problem") or design.get("errors") or design
    page = watched.page
    watched.open(place, timeout=LONG)
    expect(page.locator("[data-result]")).to_have_count(10, timeout=LONG)
    page.get_by_text("Every criterion of every variant").click()
    rows = page.locator(".all-criteria tbody tr:not(.base)")
    expect(rows).to_have_count(9)
    names = page.locator(".all-criteria thead th.criterion").all_text_contents()
    titles = [one.get_attribute("title") for one in page.locator("main [title]").all()]
    texts = [line for line in page.locator("main").inner_text().splitlines() if line.strip()]
    film = [name.strip().lower() for name in names].index("film: minimum film thickness")
    for row in rows.all():
        mark = row.locator("td.judged").nth(film).locator(".mark")
        title = mark.get_attribute("title")
        assert mark.get_attribute("class").split()[1] in ("met", "not_met"), title
        assert "minimum film thickness" in title
        assert assert_true(title) == 1, title
    assert sum(map(assert_true, [*titles, *texts])) > 20
    assert not watched.faults()
    id = place.rpartition("/")[2]
    assert_equal_on_page_and_in_files(http, watched.url, id)
    assert_equal_in_print(http, id, tmp_path)
