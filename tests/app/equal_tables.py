"""The table of results of variants has equal numbers on page, in files, in print and in the client."""

import csv
import io
import re
import shutil
import subprocess
from html.parser import HTMLParser

import pytest
from openpyxl import load_workbook
from patience import until
from serving import API

from app.client import Client

PDF_TO_TEXT = shutil.which("pdftotext")
DIGITS = 5  # of a printed number


class PageTable(HTMLParser):
    """The numbers of the table of results on a page, with all digits and as printed, by row."""

    def __init__(self, text):
        super().__init__()
        self.exact, self.printed, self.units = {}, {}, []
        self.row = self.text = None
        self.feed(text.partition('class="results-table"')[2].partition("</table>")[0])

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        if "data-result" in attrs:
            self.row = attrs["data-result"]
            self.exact[self.row], self.printed[self.row] = [], []
        self.text = None
        if "data-number" in attrs:
            self.exact[self.row].append(float(attrs["data-number"]))
            self.text = self.printed[self.row]

    def handle_data(self, data):
        if self.text is not None and data.strip():
            self.text.append(float(data.strip().removesuffix("%")))
            self.text = None


def results(http, id):
    """The table as the interface returns it."""
    return http.get(f"{API}/designs/{id}/variants").json()["table"]


def assert_equal_on_page_and_in_files(http, url, id):
    """Compare page, CSV, XLSX and client with the interface, digit by digit."""
    table, place = results(http, id), f"{API}/designs/{id}/variants"
    names = [row["name"] for row in table["rows"]]
    values = {row["name"]: row["values"] for row in table["rows"]}
    used = {row["name"]: row["utilisation"] for row in table["rows"]}
    assert len(table["columns"]) > 2
    with Client(url) as client:
        assert client.variants(id).table.plain() == table
    page = PageTable(http.get(f"/designs/{id}", headers={"Accept": "text/html"}).text)
    assert page.exact == {name: [*values[name], used[name]] for name in names}
    for name in names:
        assert page.printed[name] == [*map(printed, values[name]), per_cent(used[name])]
    lines = list(csv.reader(io.StringIO(http.get(f"{place}.csv").text)))
    sheet = load_workbook(io.BytesIO(http.get(f"{place}.xlsx").content)).active
    at = [lines[0].index(f"results: {one['words']}") for one in table["columns"]]
    assert [lines[1][i] or "1" for i in at] == [one.get("unit", "1") for one in table["columns"]]
    assert [line[0] for line in lines[2:]] == [name for name in names if name != "base"]
    for line, cells in zip(lines[2:], sheet.iter_rows(min_row=3, values_only=True), strict=True):
        assert cells[0] == line[0]
        assert [float(line[i]) for i in at] == values[line[0]]
        assert [cells[i] for i in at] == pytest.approx(values[line[0]], rel=1e-15)


def printed(value):
    """A number with the digits of a printed one."""
    return float(f"{value:.{DIGITS}g}")


def per_cent(used):
    """A used share as printed: two digits, and four near and above the limit."""
    return float(f"{100 * used:.{2 if used < 0.985 else 4}g}")


def assert_equal_in_print(http, id, tmp_path):
    """Compare the first page of the report, and its number of pages, with the interface."""
    file = tmp_path / "report.pdf"
    file.write_bytes(until(lambda: report(http, id), lambda content: content.startswith(b"%PDF")))
    whole = text_of(file)
    first, pages = whole.partition("\f")[0], whole.count("\f")
    assert pages <= 6
    for row in results(http, id)["rows"]:
        title = "design itself" if row["name"] == "base" else row["name"]
        line = next(line for line in first.splitlines() if re.match(rf"{re.escape(title)} +[\d.]", line))
        shown = line.removeprefix(title).split()[: len(row["values"])]
        assert [float(number) for number in shown] == [*map(printed, row["values"])], line
        share = re.search(r"([\d.]+) %", line)
        assert float(share.group(1)) == per_cent(row["utilisation"])


def report(http, id):
    return http.get(f"{API}/designs/{id}/variants/report.pdf", headers={"Prefer": "wait=30"}).content


def text_of(file):
    command = [PDF_TO_TEXT, "-layout", str(file), "-"]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout
