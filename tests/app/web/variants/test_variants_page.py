"""The design page edits the table of variants in place, pastes spreadsheets, and shows faults in place."""

import io
import re
import zipfile

import pypdf
import pytest
from axe_playwright_python.sync_playwright import Axe
from browsing import created, settled
from openpyxl import Workbook, load_workbook
from playwright.sync_api import expect
from serving import API

MAINS = [f"main_{n}" for n in range(1, 6)]
BIG_ENDS = [f"big_end_{n}" for n in range(1, 5)]
NINE = [*BIG_ENDS, *MAINS]
XLSX = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"
LONGEST = 3500  # pixels of the page of nine bearings, 1440 wide


def book_of(*rows):
    book = Workbook()
    for row in rows:
        book.active.append(row)
    stream = io.BytesIO()
    book.save(stream)
    return stream.getvalue()


def file_of(content, name="engine.xlsx"):
    return {"name": name, "mimeType": XLSX if name.endswith("xlsx") else "text/csv", "buffer": content}


def engine():
    """Five mains and four big ends: loads, diameters, widths; one main with a larger clearance."""
    head = [
        "variant",
        "film.radial_load",
        "film.bearing_diameter",
        "film.bearing_width",
        "film.diametral_clearance",
    ]
    mains = [[name, 20 + n, None, None, 70 if name == "main_3" else None] for n, name in enumerate(MAINS)]
    ends = [[name, 18 + n / 2, 45, 18, None] for n, name in enumerate(BIG_ENDS)]
    return book_of(head, ["unit", "kN", "mm", "mm", "um"], *mains, *ends)


def put(http, place, content, media="text/csv"):
    tag = http.get(f"{API}{place}").headers["etag"]
    headers = {"Content-Type": media, "If-Match": tag, "Prefer": "wait=30"}
    return http.put(f"{API}{place}/variants", content=content, headers=headers)


@pytest.fixture
def shell(http):
    """The address of a design with an oil film and a shell."""
    return created(http, "shell")


@pytest.fixture
def two(http, shell):
    """The same with two variants."""
    text = "variant,film.radial_load,film.speed\nunit,kN,rpm\nmain_1,21,\nmain_2,22,4000\n"
    assert put(http, shell, text.encode()).status_code == 200
    return shell


def upload(page, file):
    page.get_by_label("Table from a file").set_input_files(file)


@pytest.mark.slow
def test_nine_bearings_of_an_engine_are_one_design_made_from_a_spreadsheet(watched, http, shell):
    page = watched.page
    watched.open(shell)
    page.get_by_text("Variants", exact=True).click()
    upload(page, file_of(engine()))
    expect(page.locator(".variants tbody tr[id]:not(.base)")).to_have_count(9, timeout=60_000)
    design = settled(http, shell)
    assert list(design["variants"]) == NINE
    assert design["variants"]["big_end_2"] == {
        "film.bearing_diameter": "45 mm",
        "film.bearing_width": "18 mm",
        "film.radial_load": "18.5 kN",
    }
    watched.open(shell)
    answer = http.get(f"{API}{shell}/variants").json()
    governing = answer["governing"]["variant"]
    expect(page.locator("[data-governing-variant]")).to_contain_text(
        re.compile(f"9 variants: .*{governing}.* govern")
    )
    expect(page.locator(f"#variant-{governing}")).to_contain_text("governs")
    solids = {row["models"]["model"]["build"] for row in answer["rows"]}
    assert len(solids) == 2
    pictures = page.locator(".variants tr[id]:not(.base) .files img")
    expect(pictures).to_have_count(9)
    heights = page.evaluate("document.documentElement.scrollHeight")
    assert heights <= LONGEST
    page.set_viewport_size({"width": 390, "height": 800})
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    box, name = page.locator(".variants-sheet .scroll").first, page.locator("[data-result=main_5] th")
    box.evaluate("(box) => { box.scrollLeft = 500; }")
    assert abs(name.bounding_box()["x"] - box.bounding_box()["x"]) < 2
    assert watched.faults() == []


@pytest.mark.slow
def test_the_report_and_the_files_have_all_nine(http, shell):
    assert put(http, shell, engine(), XLSX).status_code == 200
    settled(http, shell)
    screen = http.get(f"{API}{shell}/variants/report.html", headers={"Prefer": "wait=60"})
    assert screen.status_code == 200
    whole = http.get(f"{API}{shell}/variants/report.html?appendix=true", headers={"Prefer": "wait=60"})
    paper = http.get(f"{API}{shell}/variants/report.pdf", headers={"Prefer": "wait=60"})
    text = "".join(page.extract_text() for page in pypdf.PdfReader(io.BytesIO(paper.content)).pages)
    governing = http.get(f"{API}{shell}/variants").json()["governing"]["variant"]
    for name in NINE:
        assert f'data-variant="{name}"' in screen.text
        assert name in text
    assert f"Criteria of {governing}, which governs" in screen.text
    assert "Film: radial load" in text
    assert screen.text.count("<figcaption>Model of ") == 0
    assert whole.text.count("<figcaption>Model of ") == 2
    with zipfile.ZipFile(io.BytesIO(http.get(f"{API}{shell}/variants.zip").content)) as archive:
        assert len(archive.namelist()) == 9


@pytest.mark.slow
def test_a_downloaded_table_is_taken_back_without_a_new_revision(watched, http, two):
    page = watched.page
    watched.open(two)
    for kind in ("XLSX", "CSV"):
        with page.expect_download() as caught:
            page.locator(".variants-sheet").get_by_role("link", name=kind).click()
        upload(page, file_of(caught.value.path().read_bytes(), f"table.{kind.lower()}"))
        page.wait_for_url("**#variants")
    assert http.get(f"{API}{two}").json()["revision"] == 2
    sheet = load_workbook(io.BytesIO(http.get(f"{API}{two}/variants.xlsx").content))["variants"]
    assert [cell.value for cell in sheet[4]][:3] == ["main_2", 22, 4000]
    assert "results: verdict" in [cell.value for cell in sheet[1]]


@pytest.mark.slow
@pytest.mark.parametrize("scheme", [pytest.param("light", marks=pytest.mark.slow), "dark"])
def test_the_table_has_no_serious_fault_of_accessibility(watched, two, scheme):
    watched.page.emulate_media(color_scheme=scheme)
    watched.open(two, wait_until="networkidle")
    violations = Axe().run(watched.page).response["violations"]
    serious = [one for one in violations if one["impact"] in ("serious", "critical")]
    assert [(one["id"], one["nodes"][0]["target"]) for one in serious] == []


@pytest.mark.slow
def test_faulty_cells_of_a_file_are_shown_in_place(watched, http, shell):
    page = watched.page
    watched.open(shell)
    page.get_by_text("Variants", exact=True).click()
    rows = (
        ["variant", "film.radial_load", "film.wdth"],
        ["unit", "kN", "mm"],
        ["main_1", "60 umm", 5],
        ["main_2", "=1+1", 5],
    )
    upload(page, file_of(book_of(*rows)))
    wrong = page.locator("[name='cell.B3']")
    expect(wrong).to_have_value("60 umm")
    expect(wrong).to_have_attribute("aria-invalid", "true")
    expect(page.locator("#B3-error")).to_contain_text("umm")
    expect(page.locator("#B4-error")).to_contain_text("formula")
    expect(page.locator("[name='cell.C1']")).to_have_value("film.wdth")
    expect(page.locator(".variants thead")).to_contain_text("bearing_width")
    assert http.get(f"{API}{shell}").json()["revision"] == 1
    wrong.fill("21")
    page.locator("[name='cell.B4']").fill("= 2 * 11 kN")
    page.locator("[name='cell.C1']").fill("film.bearing_width")
    page.get_by_role("button", name="Save the variants").click()
    expect(page.locator(".variants tbody tr[id]:not(.base)")).to_have_count(2, timeout=60_000)
    assert http.get(f"{API}{shell}").json()["variants"] == {
        "main_1": {"film.bearing_width": "5 mm", "film.radial_load": "21 kN"},
        "main_2": {"film.bearing_width": "5 mm", "film.radial_load": "= 2 * 11 kN"},
    }


@pytest.mark.slow
def test_a_calculation_that_refuses_a_value_is_shown_in_its_cell(watched, http, two):
    page = watched.page
    watched.open(two)
    page.get_by_label("film.radial_load of main_2").fill("-3")
    page.get_by_role("button", name="Save the variants").click()
    expect(page.locator("[name='cell.B4']")).to_have_attribute("aria-invalid", "true")
    expect(page.locator("#B4-error")).to_contain_text("radial load")
    assert http.get(f"{API}{two}").json()["revision"] == 2


@pytest.mark.slow
def test_variants_are_renamed_added_and_removed_in_place(watched, http, two):
    page = watched.page
    watched.open(two)
    page.locator("[name='cell.A3']").fill("front")
    page.locator("[name='cell.A5']").fill("rear")
    page.get_by_label("film.radial_load of a new variant").first.fill("30")
    expect(page.locator("tr[data-row]")).to_have_count(4)
    page.get_by_role("button", name="Save the variants").click()
    expect(page.locator("#variant-rear")).to_be_visible(timeout=60_000)
    assert http.get(f"{API}{two}").json()["variants"] == {
        "front": {"film.radial_load": "21 kN"},
        "main_2": {"film.radial_load": "22 kN", "film.speed": "4000 rpm"},
        "rear": {"film.radial_load": "30 kN"},
    }
    page.get_by_role("button", name="Remove main_2").click()
    expect(page.locator("#variant-main_2")).to_have_count(0, timeout=60_000)
    assert list(http.get(f"{API}{two}").json()["variants"]) == ["front", "rear"]


@pytest.mark.slow
def test_five_mains_are_typed_as_a_newcomer_writes_them(watched, http, shell):
    """By a link from the top; a heading in words, names with spaces, loads in the unit of the design."""
    page = watched.page
    watched.open(shell)
    page.get_by_role("link", name="Compare variants").click()
    expect(page.locator("[name='cell.B1']")).to_be_visible()
    page.locator("[name='cell.B1']").fill("Radial load")
    expect(page.locator("[name='cell.B2']")).to_have_attribute("placeholder", "kN")
    for row, load in enumerate((21, 24, 26, 24, 20), 3):
        page.locator(f"[name='cell.A{row}']").fill(f"main {row - 2}")
        page.locator(f"[name='cell.B{row}']").fill(str(load))
    page.get_by_role("button", name="Save the variants").click()
    expect(page.locator("[data-governing-variant]")).to_contain_text("main_3", timeout=60_000)
    variants = settled(http, shell)["variants"]
    assert variants["main_3"] == {"film.radial_load": "26 kN"}
    assert list(variants) == MAINS
    watched.open(f"{shell}/studies/new")
    expect(page.locator("[data-governing]")).to_contain_text("main_3 governs")
    expect(page.locator("[data-governing]")).to_contain_text("film.radial_load 26 kN")
    assert watched.faults() == []


@pytest.mark.slow
def test_a_block_of_a_spreadsheet_is_pasted_into_the_cells(watched, http, two):
    page = watched.page
    watched.open(two)
    cell = page.locator("[name='cell.A4']")
    cell.focus()
    cell.evaluate(
        """(cell, text) => {
            const clipboardData = new DataTransfer(), options = { bubbles: true, cancelable: true };
            clipboardData.setData("text/plain", text);
            cell.dispatchEvent(new ClipboardEvent("paste", { clipboardData, ...options }));
        }""",
        "main_2\t25\t4500\r\nmain_3\t26\t\r\nmain_4\t27\t\r\n",
    )
    expect(page.locator("[name='cell.A6']")).to_have_value("main_4")
    page.get_by_role("button", name="Save the variants").click()
    expect(page.locator("[data-result=main_4]")).to_be_visible(timeout=60_000)
    variants = http.get(f"{API}{two}").json()["variants"]
    assert variants["main_2"] == {"film.radial_load": "25 kN", "film.speed": "4500 rpm"}
    assert variants["main_4"] == {"film.radial_load": "27 kN"}


@pytest.mark.slow
def test_upload_pasting_and_one_more_row_work_without_scripts(plain, http, shell):
    page = plain.page
    plain.open(shell)
    page.get_by_text("Variants", exact=True).click()
    page.get_by_label("Table from a file").set_input_files(
        file_of(b"variant;film.radial_load\nunit;kN\nmain_1;21,5\n", "table.csv")
    )
    page.get_by_role("button", name="Upload").click()
    expect(page.locator("#variant-main_1")).to_be_visible()
    page.locator("[name='cell.A4']").fill("main_2")
    page.locator("[name='cell.C1']").fill("film.speed")
    page.locator("[name='cell.C4']").fill("4000")
    page.locator("[name='cell.A4']").press("Enter")
    expect(page.locator("#variant-main_2")).to_be_visible()
    assert http.get(f"{API}{shell}").json()["variants"] == {
        "main_1": {"film.radial_load": "21.5 kN"},
        "main_2": {"film.speed": "4000 rpm"},
    }
    page.get_by_text("Paste from a spreadsheet").click()
    page.get_by_label("Headings, units, one row per variant").fill(
        "variant\tfilm.radial_load\n\tkN\nonly\t20\n"
    )
    page.get_by_role("button", name="Insert this table").click()
    expect(page.locator("#variant-only")).to_be_visible()
    assert http.get(f"{API}{shell}").json()["variants"] == {"only": {"film.radial_load": "20 kN"}}


def test_a_table_based_on_an_old_revision_is_shown_again(http, two):
    typed = {"revision": "1", "cell.A1": "variant", "cell.A2": "unit", "cell.B1": "film.radial_load"}
    typed |= {"cell.B2": "kN", "cell.A3": "mine", "cell.B3": "33"}
    answer = http.post(f"{two}/variants", data=typed)
    assert answer.status_code == 412
    assert "Somebody else saved this design" in answer.text
    assert 'name="cell.A3" id="A3" value="mine"' in answer.text


def test_a_refused_table_offers_one_new_column_however_often_it_is_sent(http, shell):
    typed = {"revision": "1", "cell.A1": "variant", "cell.B1": "film.radial_load", "cell.B2": "kN"}
    typed |= {"cell.A3": "10 % load", "cell.B3": "33", "cell.C1": "", "cell.C2": "", "cell.D1": ""}
    answer = http.post(f"{shell}/variants", data=typed)
    assert answer.status_code == 422
    assert "&#39;10 % load&#39; is not a name" in answer.text
    assert answer.text.count('placeholder="+ input"') == 2  # of the load, and a new one


def test_a_form_that_is_none_and_a_file_that_is_none_are_refused(http, shell):
    assert (
        http.post(
            f"{shell}/variants", content=b"{}", headers={"Content-Type": "application/json"}
        ).status_code
        == 415
    )
    answer = http.post(
        f"{shell}/variants/file", files={"file": ("a.xlsx", b"PK\x03\x04 rubbish")}, data={"revision": "1"}
    )
    assert answer.status_code == 422
    assert "cannot be read as XLSX" in answer.text
    empty = http.post(f"{shell}/variants/file", data={"revision": "1"}, files={"other": ("a", b"")})
    assert empty.status_code == 422
