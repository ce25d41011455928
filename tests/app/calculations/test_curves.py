"""`POST /curves` and `pressure=@file.csv`: tables become inputs of templates; faults name their line."""

import json

import numpy as np
import pytest
from click.testing import CliRunner
from serving import API

from app.calculations.curves import MOST_ROWS, curves_of
from app.calculations.tables import MOST_FAULTS
from app.cli.main import main
from templates.bearing_load.bearing_load_v1 import BearingLoad
from templates.core.errors import InvalidInputs

PLAIN = "crank angle [deg], pressure [bar]\n0, 1.0\n180, 1.5\n360, 60\n540, 3.5\n"
PRESSURE = {"value": [1.0, 1.5, 60.0, 3.5], "unit": "bar"}
ANGLE = {"value": [0.0, 180.0, 360.0, 540.0], "unit": "deg"}


def faults(text):
    body = text if isinstance(text, bytes) else text.encode()
    with pytest.raises(InvalidInputs) as refusal:
        curves_of(body)
    return [(fault.name, fault.code) for fault in refusal.value.faults]


class TestReading:
    @pytest.mark.parametrize(
        "text",
        [
            PLAIN,
            PLAIN.replace("\n", "\r\n"),
            "\ufeff" + PLAIN,
            "crank_angle_deg,pressure_bar\n0,1\n180,1.5\n360,6e1\n540,3.5\n",
            "Crank angle (deg);Pressure (bar)\n0;1,0\n180;1,5\n360;60\n540;3,5\n",
            "crank angle [deg]\tpressure [bar]\n0\t1\n180\t1,5\n360\t60\n540\t3.5",
            '# measured 1993\n\n"crank angle [deg]","pressure [bar]"\n"0","1"\n180,1.5\n\n360,60\n540,3.5\n',
        ],
    )
    def test_property_forms_of_one_table(self, text):
        assert curves_of(text.encode()).curves == {"crank_angle": ANGLE, "pressure": PRESSURE}

    def test_property_number_without_unit(self):
        assert curves_of(b"load factor [-]\n0.5\n").curves["load_factor"] == {"value": [0.5], "unit": "1"}

    @pytest.mark.parametrize(
        ("text", "expected"),
        [
            ("", [("table", "empty")]),
            ("pressure [bar]\n", [("table", "empty")]),
            ("pressure\n1\n", [("line 1", "missing_unit")]),
            ("[bar]\n1\n", [("line 1", "missing_name")]),
            ("pressure [barometer]\n1\n", [("line 1", "unknown_unit")]),
            ("p [m**9**9**9]\n1\n", [("line 1", "unknown_unit")]),
            ("p [bar], p [bar]\n1, 2\n", [("line 1", "named_twice")]),
            ("p [bar], q [bar]\n1, 2\n1\n3,4,5\n", [("line 3", "ragged"), ("line 4", "ragged")]),
            ("p [bar], q [bar]\n1,5, 2,5\n", [("line 2", "ragged")]),
            ("p [bar]; q [bar]\n1,5; x\n;2\n", [("line 2", "not_a_number"), ("line 3", "not_a_number")]),
            ("p [bar]; q [bar]\n1.234,5; 1\n", [("line 2", "not_a_number")]),
            ("p [bar]\nnan\ninf\n1e999\n0x1\n1_0\n",
             [(f"line {n}", "not_finite" if n == 4 else "not_a_number") for n in range(2, 7)]),
            (b"p [bar]\n1\n\xff\n", [("line 3", "not_a_number")]),
            ("p [bar]\n" + "1\n" * (MOST_ROWS + 2), [("table", "too_many_rows")]),
            ("p [bar]\n" + "1" * 5000, [("line 2", "too_long")]),
            (",".join(f"p{i} [bar]" for i in range(40)), [("table", "too_many_columns")]),
            ("p [bar]\n" + "x\n" * 100,
             [*((f"line {n}", "not_a_number") for n in range(2, 2 + MOST_FAULTS)), ("table", "more_faults")]),
        ],
    )  # fmt: skip
    def test_property_faults_name_their_lines(self, text, expected):
        assert faults(text) == expected

    def test_property_any_bytes_are_read_or_refused(self):
        rng = np.random.default_rng(5)
        letters = np.frombuffer(b'0123456789.,;\t\n\r"#[]()eE+- abp_\xc3\xa9\xff\x00', dtype=np.uint8)
        for _ in range(2000):
            body = bytes(rng.choice(letters, rng.integers(0, 60)))
            header = b"p [bar]\n" if rng.random() < 0.7 else b""
            try:
                curves = curves_of(header + body).curves
            except InvalidInputs as refusal:
                faulty = refusal.faults
            else:
                assert all(np.isfinite(curve["value"]).all() for curve in curves.values())
                continue
            assert all(fault.detail for fault in faulty)


class TestInterface:
    def test_property_curve_is_ready_for_inputs(self, http):
        rows = "".join(f"{a},{1 + 50 * np.exp(-(((a - 370) / 25) ** 2))}\n" for a in range(0, 720, 5))
        table = "crank_angle_deg,pressure_bar\n" + rows
        answer = http.post(f"{API}/curves", content=table, headers={"Content-Type": "text/csv"})
        assert answer.status_code == 200
        curves = answer.json()["curves"]
        inputs = {**BearingLoad.example, "gas_cycle": "table", "pressure": curves["pressure"],
                  "pressure_angle": curves["crank_angle"]}  # fmt: skip
        response = http.post(f"{API}/templates/bearing_load/versions/1/evaluate", json={"inputs": inputs})
        assert response.status_code == 200, response.text
        assert response.json()["outputs"]["mean_torque"]["value"] > 0

    def test_property_faults_are_a_problem(self, http):
        answer = http.post(f"{API}/curves", content="p [bar]\nx\n", headers={"Content-Type": "text/csv"})
        assert answer.status_code == 422
        assert answer.headers["content-type"] == "application/problem+json"
        (error,) = answer.json()["errors"]
        assert (error["name"], error["code"]) == ("line 2", "not_a_number")

    @pytest.mark.parametrize("kind", ["application/json", "text/plain", "text/csv; charset=ebcdic", ""])
    def test_property_other_types_are_refused(self, http, kind):
        answer = http.post(f"{API}/curves", content=PLAIN, headers={"Content-Type": kind})
        assert answer.status_code == 415
        assert "text/csv" in answer.json()["detail"]

    def test_property_curves_convert_their_units(self, http):
        body = {"inputs": BearingLoad.example, "outputs": ["crankpin_load_x", "gas_pressure"]}
        address = f"{API}/templates/bearing_load/versions/1/evaluate"
        plain = http.post(address, json=body).json()["outputs"]
        other = {**body, "units": {"crankpin_load_x": "lbf", "gas_pressure": "psi"}}
        outputs = http.post(address, json=other).json()["outputs"]
        assert outputs["crankpin_load_x"]["unit"] == "lbf"
        ratio = np.array(plain["gas_pressure"]["value"]) / outputs["gas_pressure"]["value"]
        assert ratio == pytest.approx(0.0689475729, rel=1e-9)


class TestCommandLine:
    def run(self, *arguments):
        given = [f"{n}={v if isinstance(v, str) else json.dumps(v)}" for n, v in BearingLoad.example.items()
                 if n not in ("gas_cycle",)]  # fmt: skip
        return CliRunner().invoke(main, ["evaluate", "bearing_load", *given, *arguments])

    def test_property_curves_from_a_file(self, tmp_path):
        rows = "".join(f"{a};{str(1.5 + a / 720).replace('.', ',')}\n" for a in range(0, 720, 10))
        (tmp_path / "diagram.csv").write_text("crank angle [deg];pressure [bar]\n" + rows, encoding="utf-8")
        file = f"@{tmp_path}/diagram.csv"
        ran = self.run("gas_cycle=table", f"pressure={file}", f"pressure_angle={file}:crank_angle")
        assert ran.exit_code == 0, ran.output
        assert "crankpin_load_x" in ran.output
        assert "24 values" in ran.output

    def test_property_faults_are_reported(self, tmp_path):
        (tmp_path / "d.csv").write_text("p [bar]\n1\n", encoding="utf-8")
        missing = self.run("gas_cycle=table", f"pressure=@{tmp_path}/none.csv")
        assert missing.exit_code == 1
        assert "cannot be read" in missing.output
        column = self.run("gas_cycle=table", f"pressure=@{tmp_path}/d.csv")
        assert "has no column pressure" in column.output
