"""The template search on the home page works by keyboard."""

import pytest
from browsing import CHROMIUM
from playwright.sync_api import expect

pytestmark = pytest.mark.skipif(
    not CHROMIUM, reason="needs Debian's package chromium-headless-shell or chromium"
)


@pytest.mark.slow
def test_templates_are_searched_by_an_author_and_shown_whole_again(watched):
    page = watched.page
    watched.open("/")
    cards = page.locator("section[aria-labelledby=templates] .card")
    everything = cards.count()
    field = page.get_by_role("searchbox", name="Title, standard, author, symbol")
    field.fill("Sommerfeld")
    field.press("Enter")
    expect(page).to_have_url(f"{watched.url}/?template=Sommerfeld#templates")
    assert 0 < cards.count() < everything
    section = page.locator("section[aria-labelledby=templates]")
    expect(section.locator(".notice").first).to_contain_text("S = 1/(2 pi So)")
    expect(page.get_by_role("searchbox", name="Title, standard, author, symbol")).to_have_value("Sommerfeld")
    page.get_by_role("searchbox", name="Title, standard, author, symbol").fill("xyzzy bearing")
    page.get_by_role("button", name="Search templates").click()
    expect(section).to_contain_text("No template has these words.")
    assert cards.count() == 0
    section.get_by_role("link", name="All", exact=True).click()
    expect(cards).to_have_count(everything)
    assert watched.faults() == []
