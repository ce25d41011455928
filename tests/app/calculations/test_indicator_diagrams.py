"""`/curves` and a page's paste dialog read indicator diagrams in the formats of measuring programs."""

import base64
import io
import json
import zipfile

import numpy as np
import pytest
from click.testing import CliRunner
from openpyxl import Workbook
from serving import API

from app.calculations.curves import MOST_BYTES, MOST_UNPACKED, curves_of
from app.cli.main import main
from app.schemas.tables import PastedTable, TableField
from app.web.lists.columns import paste
from templates.bearing_load.bearing_load_v1 import BearingLoad
from templates.core.errors import InvalidInputs

XLSX = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"
FIELDS = [
    TableField(name="load.pressure_angle", words="pressure angle", symbol="\\theta_{p}", unit="deg"),
    TableField(name="load.pressure", words="pressure", symbol="p", unit="bar"),
]


def gas(angle, peak=50.0):
    """A pressure over the crank angle of four strokes [bar]: combustion just after 360 deg."""
    return 1 + peak * np.exp(-(((np.asarray(angle) % 720 - 370) / 25) ** 2))


def read(text):
    """Values and units by name, and what was assumed, at `/curves`; the page must agree."""
    body = text if isinstance(text, bytes) else text.encode()
    result = curves_of(body)
    page = paste(PastedTable(text="", file=base64.b64encode(body).decode(), fields=FIELDS))
    assert page.assumed == result.assumed
    if page.texts and not page.notes:
        assert page.rows == len(next(iter(result.curves.values()))["value"])
    return {name: (curve["value"], curve["unit"]) for name, curve in result.curves.items()}, result.assumed


def faults(body):
    with pytest.raises(InvalidInputs) as refusal:
        curves_of(body if isinstance(body, bytes) else body.encode())
    return [(fault.name, fault.code, fault.detail) for fault in refusal.value.faults]


def book(*rows, visible=True):
    workbook = Workbook()
    for row in rows:
        workbook.active.append(row)
    if not visible:
        workbook.create_sheet("other")
        workbook.active.sheet_state = "hidden"
    stream = io.BytesIO()
    workbook.save(stream)
    return stream.getvalue()


class TestHeadings:
    @pytest.mark.parametrize("separator", [",", ";", "\t"])
    def test_a_row_of_units_below_the_names(self, separator):
        rows = [["crank angle", "pressure"], ["deg", "bar"], ["0", "1.5"], ["180", "2"]]
        curves, _ = read("\n".join(map(separator.join, rows)))
        assert curves == {"crank_angle": ([0, 180], "deg"), "pressure": ([1.5, 2], "bar")}

    @pytest.mark.parametrize(
        "written",
        [
            "°KW",
            "° KW",
            "°CA",
            "degCA",
            "deg CA",
            "deg. CA".replace(".", ""),
            "CAD",
            "CA°",
            "Grad KW",
            "°C.A.",
            "degCrank",
        ],
    )
    @pytest.mark.parametrize(
        "form", ["phi [{0}];p [bar]\n{1}", "phi;p\n{0};bar\n{1}", "phi / {0};p / bar\n{1}"]
    )
    def test_crank_angles_by_name(self, written, form):
        curves, assumed = read(form.format(written, "0;1\n90;2\n"))
        assert curves == {"phi": ([0, 90], "deg"), "p": ([1, 2], "bar")}
        assert assumed == [written]

    def test_degrees_in_german(self):
        curves, assumed = read("KW [Grad],p [bar]\n0,1.5\n90,2.5\n")
        assert curves["kw"] == ([0, 90], "deg")
        assert "Grad: degrees" in assumed

    @pytest.mark.parametrize(
        ("written", "kind", "unit"),
        [
            ("bara", "absolute", "bar"), ("bar(a)", "absolute", "bar"), ("bar abs", "absolute", "bar"),
            ("barg", "gauge", "bar"), ("bar(g)", "gauge", "bar"), ("bar_g", "gauge", "bar"),
            ("barü", "gauge", "bar"), ("psia", "absolute", "psi"), ("psig", "gauge", "psi"),
            ("kPa(a)", "absolute", "kPa"), ("kPa (abs)", "absolute", "kPa"), ("MPa abs", "absolute", "MPa"),
            ("mbar abs.", "absolute", "mbar"),
        ],
    )  # fmt: skip
    def test_absolute_and_gauge_pressures_keep_their_numbers_and_say_so(self, written, kind, unit):
        for head in (f"phi [deg];p [{written}]", f"phi (deg);p ({written})", f"phi;p\ndeg;{written}"):
            curves, assumed = read(f"{head}\n0;1\n90;2\n")
            assert curves["p"] == ([1, 2], unit)
            assert len(assumed) == 1
            assert f"{kind} pressure" in assumed[0]

    @pytest.mark.parametrize(
        ("head", "angle", "pressure"),
        [
            ("\ufeff°KW;bar\r", "deg", "bar"),
            ("deg;psi", "deg", "psi"),
            ("rad;kPa", "rad", "kPa"),
            ("[°CA];[bar(a)]", "deg", "bar"),
            ("deg;HPA", "deg", "hPa"),
        ],
    )
    def test_headings_that_are_only_units(self, head, angle, pressure):
        curves, _ = read(f"{head}\n-1;1,5\n1;2,5\n")
        assert curves == {"crank_angle": ([-1, 1], angle), "pressure": ([1.5, 2.5], pressure)}

    def test_two_pressures_with_headings_that_are_only_units(self):
        curves, _ = read("°CA;bar;bar\n0;1;2\n90;3;4\n")
        assert curves["pressure_2"] == ([2, 4], "bar")

    def test_lines_above_the_headings_and_comments(self):
        text = "Engine 7, cylinder 3\nDate;29.11.2026;x\n# a remark\nphi;p\ndeg;bar\n0;1,5\n90;2,5\n"
        curves, assumed = read(text)
        assert curves == {"phi": ([0, 90], "deg"), "p": ([1.5, 2.5], "bar")}
        assert assumed == ["decimal comma", "2 lines above the headings left out"]

    def test_columns_aligned_by_blanks(self):
        curves, assumed = read("phi [deg]   p [bar]\n  0.0    1.5\n 90.0   2.5\n")
        assert curves == {"phi": ([0, 90], "deg"), "p": ([1.5, 2.5], "bar")}
        assert assumed == ["decimal point", "columns separated by blanks"]


class TestDecimalMarks:
    @pytest.mark.parametrize(
        ("numbers", "values", "mark"),
        [
            ("1.013\n100.25", [1.013, 100.25], ["decimal point"]),
            ("1,013\n100,25", [1.013, 100.25], ["decimal comma"]),
            ("1\n100", [1, 100], []),
        ],
    )
    def test_the_mark_that_was_taken_is_stated(self, numbers, values, mark):
        rows = "\n".join(f"{90 * n};{number}" for n, number in enumerate(numbers.split("\n")))
        curves, assumed = read(f"phi [deg];p [kPa]\n{rows}\n")
        assert curves["p"] == (values, "kPa")
        assert assumed == mark

    @pytest.mark.parametrize("cell", ["1.013", "101.325", "-1.013"])
    def test_a_point_among_decimal_commas_is_refused_where_it_may_group_thousands(self, cell):
        ((name, code, detail),) = faults(f"phi [deg];p [kPa]\n0,5;{cell}\n90,5;2\n")
        assert (name, code) == ("line 2", "ambiguous_mark")
        assert cell.replace(".", "") in detail

    def test_one_column_with_decimal_commas(self):
        assert read("p [bar]\n1,5\n2,5\n") == ({"p": ([1.5, 2.5], "bar")}, ["decimal comma"])


class TestFiles:
    TEXT = "Kurbelwinkel;Zylinderdruck\n°KW;bar\n0;1,5\n90;2,5\n"

    @pytest.mark.parametrize(
        ("encoding", "said"),
        [
            ("utf-8", []), ("utf-8-sig", []), ("latin-1", ["Latin-1"]), ("cp1252", ["Latin-1"]),
            ("utf-16", ["UTF-16"]), ("utf-16-le", ["UTF-16"]), ("utf-16-be", ["UTF-16"]),
        ],
    )  # fmt: skip
    def test_letters_of_any_usual_program(self, encoding, said):
        curves, assumed = read(self.TEXT.encode(encoding))
        assert curves == {"kurbelwinkel": ([0, 90], "deg"), "zylinderdruck": ([1.5, 2.5], "bar")}
        assert assumed == [*said, "decimal comma", "°KW"]

    def test_xlsx(self):
        for visible in (True, False):
            rows = [["phi", "p"], ["°KW", "bara"], [0, 1.013], [90, 2.5], [None, None]]
            if not visible:
                with pytest.raises(InvalidInputs, match="empty"):
                    curves_of(book(*rows, visible=False))
                continue
            curves, assumed = read(book(*rows))
            assert curves == {"phi": ([0, 90], "deg"), "p": ([1.013, 2.5], "bar")}
            assert assumed == ["°KW", "bara: absolute pressure, as it stands in the file"]

    def test_hostile_files_are_refused_by_name(self):
        bomb = io.BytesIO()
        with zipfile.ZipFile(bomb, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("xl/worksheets/sheet1.xml", b" " * (MOST_UNPACKED + 1))
        crowd = io.BytesIO()
        with zipfile.ZipFile(crowd, "w") as archive:
            for n in range(600):
                archive.writestr(str(n), b"")
        sound = book(["phi [deg]", "p [bar]"], [0, 1])
        for content, code in (
            (bomb.getvalue(), "too_large"), (crowd.getvalue(), "too_large"),
            (sound[: len(sound) // 2], "damaged"), (b"PK\x03\x04 rubbish", "damaged"),
            (b"\xd0\xcf\x11\xe0" + bytes(600), "old_excel"), (b"1" * (MOST_BYTES + 1), "too_long"),
        ):  # fmt: skip
            assert [(name, found) for name, found, _ in faults(content)] == [("file", code)]

    def test_any_bytes_are_read_or_refused(self):
        rng = np.random.default_rng(7)
        starts = (b"", b"\xff\xfe", b"PK\x03\x04", b"p [bar]\n", "phi;p\n°KW;bar\n".encode("utf-16"))
        for _ in range(600):
            body = starts[rng.integers(len(starts))] + rng.bytes(int(rng.integers(0, 80)))
            try:
                curves = curves_of(body).curves
            except InvalidInputs as refusal:
                said = [fault.detail for fault in refusal.faults]
            else:
                said = [np.isfinite(curve["value"]).all() for curve in curves.values()]
            assert said
            assert all(said)

    @pytest.mark.parametrize(
        "kind", ["text/csv", "text/csv; charset=iso-8859-1", "text/csv; charset=UTF-16", XLSX]
    )
    def test_over_http(self, http, kind):
        body = (
            book(["phi", "p"], ["°KW", "bar"], [0, 1], [90, 2])
            if kind == XLSX
            else self.TEXT.encode("latin-1")
        )
        if "16" in kind:
            body = self.TEXT.encode("utf-16")
        answer = http.post(f"{API}/curves", content=body, headers={"Content-Type": kind})
        assert answer.status_code == 200, answer.text
        assert "°KW" in answer.json()["assumed"]


def table(angles, pressures, head="phi [°CA];p [bar]"):
    rows = (f"{a:.10g};{p:.10g}" for a, p in zip(angles, pressures, strict=True))
    return head + "\n" + "\n".join(rows) + "\n"


class TestCycles:
    @pytest.mark.parametrize("count", [2, 3, 10])
    @pytest.mark.parametrize("form", ["restarting", "continuous", "centred", "closed"])
    def test_cycles_of_four_strokes_become_their_mean(self, count, form):
        one = np.arange(0, 721 if form == "closed" else 720, 5.0)
        start = -360.0 if form == "centred" else 0.0
        peaks = 40 + 5 * np.arange(count)
        angles = [one + start + (720 * n if form == "continuous" else 0) for n in range(count)]
        pressures = [gas(one, peak) for peak in peaks]
        curves, assumed = read(table(np.concatenate(angles), np.concatenate(pressures)))
        assert f"{count} cycles of 720° averaged" in assumed
        assert curves["phi"][0] == pytest.approx(np.arange(0, 720, 5) + start, abs=1e-9)
        assert curves["p"][0] == pytest.approx(gas(np.arange(0, 720, 5), peaks.mean()), rel=1e-8)

    def test_cycles_of_two_strokes(self):
        one = np.arange(0, 360, 2.0)
        pressure = 1 + 30 * np.exp(-((((one + 170) % 360 - 180) / 20) ** 2))
        for angles in (np.tile(one, 3), np.arange(0, 3 * 360, 2.0)):
            curves, assumed = read(table(angles, np.tile(pressure, 3)))
            assert "3 cycles of 360° averaged" in assumed
            assert curves["p"][0] == pytest.approx(pressure, rel=1e-8)

    def test_incomplete_cycles_are_left_out_and_stated(self):
        angles = np.arange(300, 300 + 720 * 2.5, 5.0) % 720
        curves, assumed = read(table(angles, gas(angles)))
        assert "1 cycle of 720° taken" in assumed
        assert "2 incomplete left out" in assumed
        assert curves["p"][0] == pytest.approx(gas(np.arange(0, 720, 5)), rel=1e-8)

    def test_a_single_cycle_is_left_as_it_is(self):
        for one in (
            np.arange(0, 720, 5.0),
            np.arange(0, 721, 5.0),
            np.arange(-180, 540, 1.0),
            np.arange(0, 360, 1.0),
        ):
            curves, assumed = read(table(one, gas(one)))
            assert curves["phi"][0] == pytest.approx(one)
            assert not any("cycle" in one for one in assumed)

    @pytest.mark.parametrize("order", [slice(None, None, -1), np.r_[72:144, 0:72], np.r_[30:144, 0:30]])
    def test_rows_of_one_cycle_in_another_order(self, order):
        one = np.arange(0, 720, 5.0)
        curves, assumed = read(table(one[order], gas(one[order])))
        assert "rows put in order of the crank angle" in assumed
        assert curves["phi"][0] == pytest.approx(one)
        assert curves["p"][0] == pytest.approx(gas(one), rel=1e-8)

    def test_an_angle_that_is_given_twice_is_left_to_the_template(self):
        angles = [0, 90, 45, 90]
        curves, assumed = read(table(angles, [1, 2, 3, 4]))
        assert curves["phi"][0] == angles
        assert assumed == ["°CA"]

    def test_columns_of_single_cycles_and_a_count_of_cycles(self):
        rows = "\n".join(f"{a};{a};{a + 2};{a + 4}" for a in range(10))
        curves, assumed = read(f"phi [deg];p cycle 1 [bar];p cycle 2 [bar];p cycle 3 [bar]\n{rows}\n")
        assert curves["p"][0] == [a + 2 for a in range(10)]
        assert assumed == ["3 cycles averaged"]
        one = np.arange(0, 720, 10)
        rows = "\n".join(f"{n};{a};{gas(a)}" for n in (1, 2) for a in one)
        curves, assumed = read(f"cycle;phi [deg];p [bar]\n{rows}\n")
        assert curves.keys() == {"phi", "p"}
        assert "2 cycles of 720° averaged" in assumed

    def test_a_table_that_is_no_indicator_diagram_is_left_as_it_is(self):
        angles = np.tile(np.arange(0, 720, 10.0), 3)
        curves, assumed = read(table(angles, angles, "angle [deg];strain [1]"))
        assert len(curves["angle"][0]) == 216
        assert assumed == []

    def test_the_issues_example(self):
        one = np.arange(0, 720, 5)
        rows = "\n".join(
            f"{a};{p:.4f}".replace(".", ",")
            for a, p in zip(np.tile(one, 3), gas(np.tile(one, 3)), strict=True)
        )
        _, assumed = read(f"Winkel;Druck\n°CA;bar\n{rows}\n")
        assert assumed == ["decimal comma", "°CA", "3 cycles of 720° averaged"]


def pulsed(rpm=1500.0, revolutions=7.3, start=0.4, four=True, width=4.0, rate=20_000, level=(0.0, 5.0)):
    """Time [s], pressure [bar], TDC signal [V] of an engine, from `start` revolutions after combustion on."""
    turns = np.arange(0, revolutions, rpm / 60 / rate) + start
    seconds = (turns - start) * 60 / rpm
    angle = 360 + 360 * turns if four else 360 * turns
    pressure = gas(angle) if four else 1 + 50 * np.exp(-((((angle % 360 + 170) % 360 - 180) / 25) ** 2))
    off = (angle + 180) % 360 - 180
    return seconds, pressure, np.where(np.abs(off) < width / 2, level[1], level[0])


def signals(seconds, pressure, pulse, head):
    rows = (f"{t:.9g}\t{p:.9g}\t{v:.9g}" for t, p, v in zip(seconds, pressure, pulse, strict=True))
    return head + "\n" + "\n".join(rows) + "\n"


class TestPulses:
    HEAD = "time [s]\tpressure [bar]\tTDC [V]"

    @pytest.mark.parametrize("start", [0.0, 0.4, 0.99, 1.3, 1.7])
    @pytest.mark.parametrize("level", [(0.0, 5.0), (5.0, 0.0), (-0.2, 0.1)])
    def test_four_strokes_have_their_combustion_at_360_degrees(self, start, level):
        curves, assumed = read(signals(*pulsed(start=start, level=level), self.HEAD))
        angle, pressure = (np.array(curves[name][0]) for name in ("crank_angle", "pressure"))
        assert curves["crank_angle"][1] == "deg"
        assert angle[0] == 0
        assert angle[-1] < 720
        assert np.all(np.diff(angle) > 0)
        assert pressure == pytest.approx(gas(angle), abs=0.15)  # a sample is 0.45 deg long
        assert any("four strokes" in one for one in assumed)
        assert any("averaged" in one for one in assumed)
        assert any("1500 rpm" in one for one in assumed)

    def test_two_strokes_have_theirs_at_0(self):
        curves, assumed = read(signals(*pulsed(four=False), self.HEAD))
        angle = np.array(curves["crank_angle"][0])
        expected = 1 + 50 * np.exp(-((((angle + 170) % 360 - 180) / 25) ** 2))
        assert np.array(curves["pressure"][0]) == pytest.approx(expected, abs=0.3)
        assert any("two strokes" in one for one in assumed)

    def test_volts_with_and_without_a_calibration(self):
        seconds, pressure, pulse = pulsed()
        for head in ("time [ms]\tp [20 bar/V]\tOT [V]", "time\tp\ttrigger\nms\tV, 20 bar/V\tV"):
            curves, assumed = read(signals(1000 * seconds, pressure / 20, pulse, head))
            assert curves["p"][1] == "bar"
            assert max(curves["p"][0]) == pytest.approx(51, abs=0.2)
            assert any("20 bar/V" in one for one in assumed)
        curves, assumed = read(signals(seconds, pressure / 20, pulse, "time [s]\tp [V]\tTDC [V]"))
        assert curves["p"][1] == "V"
        assert "calibration" in assumed[-1]

    @pytest.mark.parametrize(
        ("change", "code"),
        [
            (lambda t, v: (t, 0 * v), "no_pulses"),
            (lambda t, v: (t, np.where((t > 0.1) & (t < 0.15), 0, v)), "uneven_pulses"),
            (lambda t, v: (t[::-1], v), "unordered"),
            (lambda t, v: (t, np.where(t < 0.08, v, 0)), "no_pulses"),
        ],
    )
    def test_pulses_that_give_no_angle_are_refused_by_name(self, change, code):
        seconds, pressure, pulse = pulsed()
        seconds, pulse = change(seconds, pulse)
        ((name, found, detail),) = faults(signals(seconds, pressure, pulse, self.HEAD))
        assert (name, found) == ("table", code)
        assert detail


class TestPage:
    def test_columns_in_another_language_go_to_the_only_field_of_their_kind(self):
        text = "Kurbelwinkel;Zylinderdruck\n°KW;bara\n0;1,5\n90;2,5\n180;2\n"
        answer = paste(PastedTable(text=text, fields=FIELDS))
        assert answer.texts == {
            "load.pressure_angle": "[0, 90, 180] deg",
            "load.pressure": "[1.5, 2.5, 2] bar",
        }
        assert answer.assumed[0] == "decimal comma"

    def test_a_file_that_is_not_in_base64_is_refused(self):
        with pytest.raises(InvalidInputs):
            paste(PastedTable(text="", file="§", fields=FIELDS))


def test_the_command_line_says_what_it_assumed(tmp_path):
    rows = "".join(f"{a};{gas(a):.3f}\n".replace(".", ",") for _ in range(2) for a in range(0, 720, 10))
    (tmp_path / "d.csv").write_text("pressure_angle;pressure\n°KW;bar\n" + rows, encoding="latin-1")
    given = [
        f"{name}={value if isinstance(value, str) else json.dumps(value)}"
        for name, value in BearingLoad.example.items()
        if name != "gas_cycle"
    ]
    file = f"@{tmp_path}/d.csv"
    ran = CliRunner().invoke(
        main,
        ["evaluate", "bearing_load", *given, "gas_cycle=table", f"pressure={file}", f"pressure_angle={file}"],
    )
    assert ran.exit_code == 0, ran.output
    assert "Latin-1, decimal comma, °KW, 2 cycles of 720° averaged" in ran.output
