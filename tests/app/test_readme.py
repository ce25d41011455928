"""The README's guide works: size the bearing by its width, rebuild it, meet the criterion."""

import re
from pathlib import Path

import pytest
from serving import API, created, patched, revision

from app.designs.gallery.gallery import GALLERY

README = " ".join((Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8").split())
FILM = "film.minimum_film_thickness"


def said(pattern):
    """Return the number that the README states there."""
    return float(re.search(pattern, README)[1])


def film_of(http, design):
    """Return the judged smallest film of the newest revision, as its page begins with it."""
    return next(one for one in revision(http, design)["criteria"] if one["name"] == "film.film")


def test_the_bearing_of_the_readme_is_sized_in_its_steps(http):
    assert "*A plain bearing at several levels*" in README
    assert GALLERY["shell"].title == "A plain bearing at several levels"
    design = created(http, GALLERY["shell"].document)
    film = film_of(http, design)
    assert film["verdict"] == "not_met"
    assert film["value"]["value"] == pytest.approx(said(r"minimum film of\s+([\d.]+) µm"), abs=0.005)
    assert film["limit"]["value"] == said(r"the permissible (\d+) µm")

    low, high = re.search(r"vary `ratio` from ([\d.]+) to ([\d.]+)", README).groups()
    asked = {
        "unknown": "ratio",
        "between": [low, high],
        "target": {FILM: f"{said(r'thickness` is ([0-9.]+) µm')} um"},
    }
    answer = http.post(f"{API}/designs/{design['id']}/solve", json=asked).json()
    (root,) = answer["roots"]
    assert root["value"] == pytest.approx(said(r"one solution, ([\d.]+\d)"), abs=5e-4)

    design = patched(http, design, {"parameters": {"ratio": str(root["value"])}})
    assert film_of(http, design)["verdict"] == "met"
    measured = http.get(f"{API}/designs/{design['id']}/measurements").json()["model"]["dimensions"]
    assert measured["width"]["value"] == pytest.approx(48 * root["value"])
