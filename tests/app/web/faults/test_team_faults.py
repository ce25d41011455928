"""In a browser, the template list links the faults of a team's file, and a design gives the reason."""

import re

import pytest
from browsing import API, THIRD
from patience import until
from playwright.sync_api import expect

BROKEN = THIRD.lstrip().replace("self.l / 3", "self.l * self.l")


@pytest.fixture
def file(http, served):
    """The file of the template `third`, put back in the end."""
    settings = served.app.state.services.settings
    path = settings.template_folders[0] / "own" / "third_v1.py"
    text = path.read_text()
    yield path
    path.write_text(text)
    until(lambda: http.get(f"{API}/templates/third/versions/1").status_code == 200)


@pytest.mark.slow
def test_a_broken_file_is_seen_from_the_list_to_the_line(watched, http, file):
    step = {"template": "third", "version": 1, "inputs": {"whole_length": "9 mm"}}
    design = http.post(f"{API}/designs", json={"name": "thirds", "steps": {"t": step}}).json()
    file.write_text(BROKEN)
    until(lambda: http.get(f"{API}/templates/third/versions/1").status_code == 404)
    page = watched.page
    watched.open("/")
    page.get_by_role("link", name=re.compile("of the team has faults|of the team have faults")).click()
    line = BROKEN[: BROKEN.index("@formula")].count("\n") + 1
    row = page.locator("section", has_text="own/third_v1.py").locator("tbody tr")
    expect(row).to_have_count(1)
    expect(row.locator("td").first).to_have_text(str(line))
    expect(row).to_contain_text("third_of_the_length is declared in mm, but its formula gives m²")
    page.get_by_role("link", name="Designs that use third version 1").click()
    page.locator(f'a[href="/designs/{design["id"]}"]').first.click()
    expect(page.get_by_role("alert")).to_contain_text("cannot be calculated now")
    expect(page.get_by_role("alert")).to_contain_text(f"line {line}")
    expect(page.locator('[data-output="t.third_of_the_length"]')).to_contain_text("3")
    file.write_text(THIRD.lstrip())
    until(lambda: http.get(f"{API}/templates/third/versions/1").status_code == 200)
    page.reload()
    expect(page.get_by_role("button", name=re.compile("^Save as revision"))).to_be_visible()
    assert watched.faults() == []
    assert http.get(f"{API}/designs/{design['id']}").json() == design
