"""Pages show and accept temperature differences, and speeds in turns."""

import pytest
from playwright.sync_api import expect
from serving import created as kept

SHEET = """# Rates
given D [mm] = 48 mm "diameter"
given N [rpm] = 5000 rpm "speed"
given T1 [degC] = 40 degC "inlet"
given T2 [degC] = 90 degC "outlet"
U [m/s] = pi*D*N "surface speed"
dT [K] = T2 - T1 "rise of both"
check dT <= 30 degC "stays cool"
"""
FILM = {
    "radial_load": "25 kN", "bearing_diameter": "48 mm", "bearing_width": "18 mm", "speed": "7000 rpm",
    "diametral_clearance": "0.05 mm", "supply_temperature": "80 degC",
    "vogel_offset": "95 K",
}  # fmt: skip


@pytest.fixture
def rise(http):
    """The address of a design whose film may rise by 30 degC, of difference."""
    step = {"template": "oil_film", "version": 2, "inputs": FILM}
    limit = {"cool": {"require": "film.temperature_rise <= 30 degC"}}
    return f"/designs/{kept(http, {'name': 'rise', 'steps': {'film': step}, 'criteria': limit})['id']}"


@pytest.mark.slow
def test_a_worksheet_reports_both_readings_at_its_line(watched, http):
    http.post("/api/v1/worksheets", json={"id": "rates", "text": SHEET}).raise_for_status()
    watched.open("/worksheets/rates")
    rows = watched.page.locator(".typeset-line")
    expect(rows.nth(5)).to_contain_text("78.957 m/s")
    expect(rows.nth(5)).to_contain_text("N is given in turns")
    expect(rows.nth(5)).to_contain_text("D*N/2")
    expect(rows.nth(6)).to_contain_text("50 K")
    expect(rows.nth(7).locator(".tag")).to_have_text("not met")
    expect(rows.nth(7)).not_to_contain_text("303")
    assert watched.faults() == []


@pytest.mark.slow
def test_a_design_shows_a_rise_in_american_units(watched, rise):
    watched.open(f"{rise}?units=us")
    shown = watched.page.locator("body")
    expect(shown).to_contain_text("116.86")  # 64.923 K
    expect(shown).to_contain_text("Δ°F")
    expect(shown).not_to_contain_text("64.923")
    assert watched.faults() == []


@pytest.mark.slow
def test_a_field_of_a_difference_names_the_unit_that_is_right(watched, rise):
    watched.open(rise)
    field = watched.page.locator("[name='film.vogel_offset']")
    field.fill("95 degC")
    expect(field).to_have_attribute("aria-invalid", "true")
    expect(watched.page.locator("body")).to_contain_text("give it in delta_degC or K")
    field.fill("171 delta_degF")
    expect(field).not_to_have_attribute("aria-invalid", "true")
