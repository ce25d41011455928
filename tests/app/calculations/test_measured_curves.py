"""A design compares a measurement from a CSV file with a calculated curve, on its page and in its report."""

from serving import API, created, revision

CSV = """# test bench, 3 August
measured angle [deg]; measured speed [rpm]
2; 1501,5
100; 1494
190; 1492,25
280; 1501
370; 1514
460; 1506
550; 1500
640; 1496
"""
CALCULATED = [1500, 1495, 1490, 1502, 1512, 1508, 1499, 1497, 1498]


def test_a_measurement_stands_beside_the_calculation(http):
    answer = http.post(f"{API}/curves", content=CSV, headers={"Content-Type": "text/csv"})
    assert answer.status_code == 200, answer.text
    curves = answer.json()["curves"]
    assert curves.keys() == {"measured_angle", "measured_speed"}
    step = {
        "template": "measured_curves", "version": 1,
        "inputs": {
            "crank_angle": {"value": [80 * k for k in range(9)], "unit": "deg"},
            "calculated_speed": {"value": CALCULATED, "unit": "rpm"}, **curves,
        },
    }  # fmt: skip
    design = created(http, {"name": "test bench", "steps": {"bench": step}})
    outputs = revision(http, design)["steps"]["bench"]["outputs"]
    # at 80 deg, between 2 and 100 deg: 1501.5 − 7.5 · 78/98 = 1495.53
    assert abs(outputs["speed_difference"]["value"][1] - (1501.5 - 7.5 * 78 / 98 - 1495)) < 1e-9
    assert outputs["film_difference"]["value"] is None
    page = http.get(f"/designs/{design['id']}").text
    assert "speed_as_measured" in page
    report = http.get(f"{API}/designs/{design['id']}/report.html").text
    assert "speed as measured" in report.lower()
    assert ">calculated speed<" in report
    assert "measured speed over measured angle" in report.lower()
