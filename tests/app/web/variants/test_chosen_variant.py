"""Without scripts, the design page shows the criteria and curves of the chosen variant."""

import re

import httpx
import pytest
from browsing import CHROMIUM
from playwright.sync_api import expect
from row_designs import CURVES
from serving import created

LOADS = {name: value for name, value in CURVES["steps"]["loads"].items() if name != "outputs"}
PARAMETERS = {name: CURVES["parameters"][name] for name in ("speed", "bore", "clearance")}
VARIANTS = {"slow": {"speed": "2000 rpm"}, "wide": {"bore": "90 mm"}}
CHARTS = re.compile(
    r'<figure class="chart"><figcaption>(.*?)</figcaption>(<svg.*?</svg>)</figure>', re.DOTALL
)


@pytest.fixture(scope="module")
def engine(served):
    with httpx.Client(base_url=served.url, timeout=90, trust_env=False) as http:
        criteria = {"light": {"require": "loads.main_load_x <= 1 GN"}}
        document = {"name": "engine", "parameters": PARAMETERS, "steps": {"loads": LOADS}}
        design = created(http, {**document, "variants": VARIANTS, "criteria": criteria})
    return f"/designs/{design['id']}"


def shown(http, engine, name):
    page = http.get(engine, params={"variant": name})
    assert page.status_code == 200
    return page.text.partition('id="chosen-variant"')[2].partition("</section>")[0]


def test_nothing_is_drawn_until_a_variant_is_chosen(http, engine):
    part = http.get(engine).text.partition('id="chosen-variant"')[2].partition("</section>")[0]
    assert "<option>slow</option>" in part
    assert not CHARTS.findall(part)


def test_the_curves_are_those_of_the_variant(http, engine):
    slow, base = (dict(CHARTS.findall(shown(http, engine, name))) for name in ("slow", "base"))
    assert slow
    assert slow.keys() == base.keys()
    assert any("load" in title.lower() for title in slow)
    assert any(slow[title] != base[title] for title in slow)
    assert 'data-criterion="light"' in shown(http, engine, "slow")


def test_a_variant_that_is_none_is_named(http, engine):
    part = shown(http, engine, "fast")
    assert 'role="alert"' in part
    assert "slow, wide" in part


@pytest.mark.slow
@pytest.mark.skipif(not CHROMIUM, reason="needs Debian's package chromium")
def test_by_mouse_without_scripts(plain, engine):
    page = plain.page
    plain.open(engine)
    page.get_by_label("Criteria and curves of").select_option("wide")
    page.get_by_role("button", name="Show", exact=True).click()
    expect(page.get_by_role("heading", name="wide")).to_be_visible()
    expect(page.locator(".variant-plots svg").first).to_be_visible()
    page.get_by_role("link", name="Close").click()
    expect(page.locator(".variant-plots svg")).to_have_count(0)
    assert plain.faults() == []
