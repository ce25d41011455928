"""In a browser, a throw has the colours of its life, from finite elements to the corners of its surface."""

import pytest
from patience import until
from playwright.sync_api import expect

PATIENCE = 60_000  # ms
THROW = {
    "journal_diameter": "55 mm", "journal_length": "26 mm", "pin_diameter": "48 mm", "pin_length": "32 mm",
    "web_thickness": "18 mm", "web_width": "80 mm", "throw": "43 mm", "fillet": "3 mm",
}  # fmt: skip
DESIGN = {
    "name": "life of a throw",
    "models": {
        "throw": {
            "id": "crank_throw", "version": 1, "parameters": THROW,
            "analyses": {"unit_loads": {"level": "coarse"}},
        },
    },
    "steps": {
        "life": {
            "template": "fatigue_life", "version": 1, "outputs": ["load_use", "safety_factor"],
            "inputs": {
                "force_1": {"value": [4, 10, 46, 22, 8, 2, -6, -9], "unit": "kN"},
                "stress_of_force_1": "= throw.unit_loads.stress_of_force_1",
                "ultimate_strength": "900 MPa",
            },
        },
    },
}  # fmt: skip
FIGURE = "document.querySelector('.solid .js-plotly-plot')"
MOST_YELLOW = f"""() => Math.max(...{FIGURE}.data[0].vertexcolor.map((one) => {{
  const [r, g, b] = one.slice(4, -1).split(',').map(Number); return g - b; }}))"""


@pytest.mark.slow
def test_the_fillets_of_a_throw_take_the_colours_of_its_life(http, watched):
    answer = http.post("/api/v1/designs", json=DESIGN)
    assert answer.status_code in (201, 202), answer.text
    address = f"/api/v1/designs/{answer.json()['id']}"
    design = until(lambda: http.get(address).json(), lambda now: now["state"] != "regenerating", 120)
    assert design["state"] == "current", design
    watched.open(f"/designs/{design['id']}")
    page = watched.page
    expect(page.locator(".solid .js-plotly-plot")).to_be_visible(timeout=PATIENCE)
    assert page.evaluate(MOST_YELLOW) < 30  # grey
    page.get_by_label("Colours show").select_option(index=1)
    expect(page.locator(".solid .colours")).to_be_visible(timeout=PATIENCE)
    assert page.evaluate(MOST_YELLOW) > 100  # yellow is the highest use
    page.get_by_label("Colours show").select_option(index=0)
    expect(page.locator(".solid .colours")).to_have_count(0, timeout=PATIENCE)
    assert page.evaluate(MOST_YELLOW) < 30
    assert watched.faults() == []
    problem = '{"detail": "the store is away"}'
    lost = {"status": 503, "content_type": "application/problem+json", "body": problem}
    page.route("**/fields/*.glb", lambda route: route.fulfill(**lost))
    page.get_by_label("Colours show").select_option(index=1)
    expect(page.get_by_role("alert").filter(has_text="the store is away")).to_be_visible(timeout=PATIENCE)
