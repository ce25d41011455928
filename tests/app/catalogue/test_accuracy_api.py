"""REST returns the measured errors, and the answers of levels as JSON."""

from serving import API

from templates.oil_film.oil_film_v2 import OilFilm

FILM = f"{API}/templates/oil_film/versions"


class TestAccuracy:
    def test_every_level_has_its_cost_and_its_errors(self, http):
        answer = http.get(f"{FILM}/2/accuracy").json()
        assert [axis["name"] for axis in answer["axes"]] == ["relative_eccentricity", "width_ratio"]
        rows, columns = (len(axis["values"]) - 1 for axis in answer["axes"])
        assert list(answer["levels"]) == list(OilFilm.levels)
        for measured in answer["levels"].values():
            assert measured["cost"]["single"] > 0
            table = measured["errors"]["minimum_film_thickness"]
            assert [len(row) for row in table] == [columns] * rows

    def test_the_paper_tells_where_it_is_unsafe(self, http):
        answer = http.get(f"{FILM}/1/accuracy").json()
        signed = answer["levels"]["only"]["signed"]["minimum_film_thickness"]
        loads, widths = (axis["values"] for axis in answer["axes"])
        column = widths.index(0.372)
        assert signed[loads.index(3)][column] > 0.2
        assert signed[loads.index(100)][column] < -0.1

    def test_unmeasured_is_not_found(self, http):
        answer = http.get(f"{API}/templates/moody/versions/1/accuracy")
        assert answer.status_code == 404


class TestLevels:
    def test_level_and_error_are_in_the_answer(self, http):
        body = {"inputs": dict(OilFilm.example), "tolerance": 0.05, "outputs": ["minimum_film_thickness"]}
        answer = http.post(f"{FILM}/2/evaluate", json=body).json()
        assert answer["level"] in OilFilm.levels
        assert 0 < answer["error"]["minimum_film_thickness"] <= 0.05

    def test_absent_outputs_are_null_with_reason(self, http):
        inputs = {**OilFilm.example, "speed": {"value": [5000, 0, -5000], "unit": "rpm"}}
        outputs = http.post(f"{FILM}/2/evaluate", json={"inputs": inputs}).json()["outputs"]
        film = outputs["minimum_film_thickness"]
        assert film["value"][1] is None
        assert "hydrodynamic_speed must be > 0" in film["reasons"][1]
        assert film["value"][0] == film["value"][2] > 0
        absent = outputs["outlet_temperature"]
        assert absent["value"] == [None] * 3
        assert absent["reasons"][0] == "needs supply_temperature"
