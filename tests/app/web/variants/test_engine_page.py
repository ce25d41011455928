"""The engine of the gallery as a page: each bearing's film is met or not met, by its own numbers."""

import pytest
from browsing import settled
from playwright.sync_api import expect
from test_true_pages import assert_true

pytestmark = pytest.mark.slow  # a crankshaft is built and solved by finite elements, ten films are marched

LONG = 480_000  # for the engine to be calculated [ms]


def test_every_bearing_of_the_engine_is_decided_on_its_page(watched, http):
    page = watched.page
    watched.open("/")
    page.locator('button[data-example="engine"]').click(timeout=LONG)
    expect(page.locator("[data-design-state]")).to_have_text("current", timeout=LONG)
    settled(http, page.url.removeprefix(watched.url).partition("#")[0])
    page.reload()
    rows = page.locator("table.variants tbody tr[id^=variant-]:not(#variant-base)")
    expect(rows).to_have_count(9)
    names = page.locator("table.variants thead th.criterion").all_text_contents()
    film = [name.strip().lower() for name in names].index("film")
    for row in rows.all():
        mark = row.locator("td.judged").nth(film).locator(".mark")
        title = mark.get_attribute("title")
        assert "met" in mark.get_attribute("class").split()[1], title
        assert "minimum film thickness" in title
        assert assert_true(title) == 1, title
    titles = [one.get_attribute("title") for one in page.locator("main [title]").all()]
    texts = [line for line in page.locator("main").inner_text().splitlines() if line.strip()]
    assert sum(map(assert_true, [*titles, *texts])) > 20
    assert not watched.faults()
    open("/tmp/truth/engine_page.txt", "w").write("\n".join([*texts, "=== titles", *titles]))
