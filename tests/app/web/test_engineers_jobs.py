"""Five jobs of an engineer, each from the front page alone; the hand counts its clicks and fields.

A job ends with its result on a page or in a file. At the end nothing went wrong on any page, and a reload
shows the same result. The last page is accessible, and no wider than a screen of 1440 or 390 pixels.
"""

import re

import numpy as np
import pytest
from axe_playwright_python.sync_playwright import Axe
from browsing import CHROMIUM
from patience import patient
from playwright.sync_api import expect
from test_newcomer import step_diameters

pytestmark = [
    pytest.mark.slow,
    pytest.mark.timeout(1800),
    pytest.mark.skipif(not CHROMIUM, reason="needs Debian's package chromium-headless-shell or chromium"),
]
LONG = patient(600_000)  # for films or solids to be calculated [ms]
ENGINE = {
    "Bore": "86",
    "Stroke": "86 mm",
    "Rod length": "145 mm",
    "Piston mass": "0,48 kg",
    "Rod mass": "0,6 kg",
    "Crank unbalance of one throw": "-8",
    "Speed": "4500 rpm",
    "Oil": "SAE 5W-30",
    "Permissible film": "1 µm",
}
BEARING = {
    "Radial load": "12 kN",
    "Diametral clearance": "50 µm",
    "Bearing diameter": "50 mm",
    "Bearing width": "26 mm",
    "Speed": "3000 rpm",
}


CRANK_STUDY = """variant	pin	journal	throw	inclination
unit	mm	mm	mm	deg
face	46	44	80	1.4
journal	46	48.4	80	4.5
pin	50.6	44	80	4.5
throw	46	44	81.5	4.5
"""


class Hand:
    """A user's hand on a page: it counts its clicks, and the fields it fills."""

    def __init__(self, watched):
        self.watched, self.page = watched, watched.page
        self.clicks, self.fields = 0, 0
        watched.open("/")

    def click(self, role, name, within=None, **options):
        self.clicks += 1
        (within or self.page).get_by_role(role, name=name, **options).first.click()

    def unfold(self, text, within=None):
        self.clicks += 1
        (within or self.page).locator("summary", has_text=text).first.click()

    def fill(self, label, text):
        self.fields += 1
        self.page.get_by_label(label, exact=True).first.fill(text)

    def choose(self, label, choice):
        self.fields += 1
        self.page.get_by_label(label).first.select_option(choice)

    def hand_in(self, label, name, content):
        self.fields += 1
        file = {"name": name, "mimeType": "text/csv", "buffer": content}
        self.page.get_by_label(label, exact=True).first.set_input_files(file)

    def wait_for_design(self):
        self.page.wait_for_url(re.compile(r"/designs/[0-9a-f]+"), timeout=LONG)
        expect(self.page.locator("[data-design-state]")).to_have_text("current", timeout=LONG)

    def numbers(self, row):
        """Each number of a row of the results by its column's title."""
        cells = self.page.locator(f"[data-result='{row}'] td.numeric")
        heads = self.page.locator(".results-table thead th.numeric")
        names = [head.get_attribute("title") for head in heads.all()]
        values = [cell.get_attribute("data-number") for cell in cells.all()]
        return {name: float(value) for name, value in zip(names, values, strict=True) if name and value}


@pytest.fixture
def hand(watched):
    hand = Hand(watched)
    yield hand
    typing = [fault for fault in watched.faults() if "422" in str(fault)]  # previews of half-typed values
    assert [fault for fault in watched.faults() if fault not in typing] == []
    for width in (1440, 390):
        hand.page.set_viewport_size({"width": width, "height": 844})
        found = Axe().run(hand.page, options={"resultTypes": ["violations"]}).response["violations"]
        assert [(one["id"], one["nodes"][0]["html"]) for one in found] == []
        assert hand.page.evaluate("document.documentElement.scrollWidth") <= width


def diagram():
    """A measured cycle as a test bench writes it: semicolons, decimal commas, from −360° to 360°."""
    angles = np.arange(-360, 361, 5.0)
    pressures = 1 + 50 * np.exp(-(((angles - 10) / 25) ** 2))
    lines = [f"{a:.1f};{p:.4f}".replace(".", ",") for a, p in zip(angles, pressures, strict=True)]
    return "\n".join(["Kurbelwinkel [°KW];Zylinderdruck [bar]", *lines]).encode("latin-1")


def describe_engine(hand, layout):
    hand.click("link", "Bearings of an engine")
    hand.choose("Layout", layout)
    for label, text in ENGINE.items():
        hand.fill(label, text)
    hand.hand_in("Indicator diagram", "zylinder.csv", diagram())
    read = hand.page.get_by_role("status").filter(has_text="Read:")
    expect(read).to_contain_text("combustion moved from 0° to 360°")
    expect(hand.page.get_by_label("Cycle", exact=True)).to_have_value("diagram")
    hand.click("button", "Calculate the bearings")
    hand.wait_for_design()


def test_a_main_bearing_from_a_measured_cycle(hand):
    describe_engine(hand, "in_line_1")
    note = hand.page.locator(".page-head")
    expect(note).to_contain_text("decimal comma")
    expect(note).to_contain_text("combustion moved from 0° to 360°")
    row = hand.page.locator("[data-result=main_1]")
    expect(row.locator(".mark")).to_have_text(re.compile("^(met|not met)"), timeout=LONG)
    film = hand.numbers("main_1")["film.minimum_film_thickness"]
    assert 0.5 < film < 20  # um
    hand.click("link", "main_1", within=row)
    chosen = hand.page.locator("#chosen-variant")
    expect(chosen).to_contain_text("main_1")
    hand.page.reload()
    expect(hand.page.locator("[data-result=main_1] .mark")).to_have_text(re.compile("^(met|not met)"))
    assert hand.numbers("main_1")["film.minimum_film_thickness"] == film
    assert hand.clicks <= 15
    assert hand.fields <= 12


def test_nine_bearings_in_one_table_with_report(hand, tmp_path):
    describe_engine(hand, "in_line_4")
    names = [*(f"big_end_{n}" for n in range(1, 5)), *(f"main_{n}" for n in range(1, 6))]
    for name in names:
        mark = hand.page.locator(f"[data-result={name}] .mark")
        expect(mark).to_have_text(re.compile("^(met|not met|undecided)"), timeout=LONG)
    films = {name: hand.numbers(name)["film.minimum_film_thickness"] for name in names}
    assert all(0.3 < film < 20 for film in films.values())  # um
    report = hand.page.locator(".variants-sheet .downloads")
    hand.click("link", "Report", within=report)
    expect(hand.page.locator("body")).to_contain_text("Assumed, not given", timeout=LONG)
    for name in names:
        expect(hand.page.locator("body")).to_contain_text(name)
    assert hand.clicks <= 15
    assert hand.fields <= 12


def test_the_width_with_the_least_power_and_a_film_of_three_micrometres(hand):
    hand.click("link", "New design")
    hand.fill("Name", "narrow bearing")
    hand.choose("Template", "oil_film/2")
    hand.click("button", "Create", exact=True)
    for label, text in BEARING.items():
        hand.fill(label, text)
    hand.fill("Oil inlet temperature", "80 degC")  # unfolds with the reason once nothing else is missing
    expect(hand.page.get_by_label("Oil outlet temperature", exact=True)).to_be_visible()
    hand.fill("Oil outlet temperature", "90 degC")
    hand.unfold("Limits of the criteria")
    hand.fill("Smallest film that its user permits", "3 µm")
    hand.click("button", "Create the design")
    hand.wait_for_design()
    hand.click("link", "New study")
    hand.page.get_by_role("radio", name=re.compile("^Optimise")).check()
    hand.clicks += 1
    page = hand.page
    page.locator("[name='place.0']").select_option("oil_film.bearing_width")
    page.locator("[name='low.0']").fill("12 mm")
    page.locator("[name='high.0']").fill("40 mm")
    page.locator("[name='objective.0']").select_option("oil_film.power_loss")
    hand.fields += 4
    standard = page.locator("label", has_text="≥ smallest permissible film")
    standard.get_by_role("checkbox").uncheck()  # that of ISO 7902 is 5 µm; this bearing may have less
    hand.clicks += 1
    hand.click("button", "Start the study")
    expect(page.locator("[data-study-state]")).to_have_text("done", timeout=LONG)
    answer = page.locator("[data-answer]")
    expect(answer).to_contain_text("Smallest power loss")
    hand.click("button", re.compile("^Use row"), within=page.get_by_role("region", name="Best row"))
    hand.wait_for_design()
    film = page.locator('[data-output="oil_film.minimum_film_thickness"] .number')
    assert float(film.text_content()) == pytest.approx(
        3, rel=0.01
    )  # the film, not the power, bounds the width
    expect(page.get_by_label("Bearing width", exact=True)).not_to_have_value("26 mm")
    assert hand.clicks <= 15


def test_the_study_of_a_crankshaft(hand):
    hand.click("button", re.compile("The paper's study of a crankshaft"))
    hand.wait_for_design()
    hand.click("link", "Compare variants")
    hand.unfold("Paste from a spreadsheet")
    hand.fill("Headings, units, one row per variant", CRANK_STUDY)
    hand.click("button", "Insert this table")
    hand.wait_for_design()
    rows = hand.page.locator("[data-result]")
    expect(rows).to_have_count(5, timeout=LONG)
    wanted = {"pin": 6.0, "journal": 10.1, "throw": -2.0, "face": 13.3}  # docs/crank_study.md, at level fine
    table = {name: hand.numbers(name)["model.torsion.stiffness"] for name in ("base", *wanted)}
    changes = {name: 100 * (table[name] / table["base"] - 1) for name in wanted}
    assert changes == pytest.approx(wanted, abs=0.3)
    shown = hand.page.locator("[data-result=face] .change").all_text_contents()
    assert f"+{wanted['face']} %" in shown
    assert hand.clicks <= 15
    assert hand.fields <= 12


def test_the_worksheet_of_the_paper(hand, tmp_path):
    hand.click("button", re.compile("The paper's main bearing"))
    hand.wait_for_design()
    page = hand.page
    inner = page.locator('[data-parameter="model.inner_diameter"] .comes-to')
    expect(inner).to_have_text("50 mm")
    hand.fill("scale", "1")
    expect(inner).to_contain_text("50 → 48 mm")
    hand.click("button", re.compile("Save as revision"))
    expect(page.locator(".page-head")).to_contain_text("revision 2", timeout=LONG)
    hand.wait_for_design()
    expect(page.locator("[data-draft]")).to_be_hidden()
    hand.clicks += 1
    with page.expect_download() as download:
        page.get_by_role("link", name="STEP", exact=True).click()
    download.value.save_as(tmp_path / "bearing.step")
    assert step_diameters((tmp_path / "bearing.step").read_bytes()) >= {48.0}
    assert hand.clicks <= 15
    assert hand.fields <= 12
