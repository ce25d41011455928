"""The report begins with the verdict; ranges and rules are separate; no limit contradicts itself."""

import re

import pytest
from serving import API, created
from test_report import on_paper, on_screen, read

DESIGNS = f"{API}/designs"


def example(http, id, version):
    return http.get(f"{API}/templates/{id}/versions/{version}").json()["example"]


@pytest.fixture(scope="module")
def judged(http):
    """A film thinner than its own limit, and one limit that nobody gave."""
    step = {"template": "oil_film", "version": 2, "inputs": example(http, "oil_film", 2)}
    criteria = {
        "thick": {"require": "film.minimum_film_thickness >= 4 um", "source": "test 7"},
        "cool": {"require": "film.film_temperature <= 110 degC", "waived": "accepted in test 12"},
    }
    return created(http, {"name": "judged", "steps": {"film": step}, "criteria": criteria})


@pytest.fixture(scope="module")
def cycle(http):
    """A film of a cycle, the limits of which are inputs that may be left out."""
    inputs = {n: v for n, v in example(http, "oil_film_cycle", 1).items() if not n.startswith("permissible")}
    return {"template": "oil_film_cycle", "version": 1, "inputs": inputs}


def test_page_and_paper_begin_with_the_verdict(http, judged):
    verdict = http.get(f"{DESIGNS}/{judged['id']}/revisions/1").json()["verdict"]
    assert verdict["counts"]["not_met"] >= 1
    for text in (on_screen(http, judged).text, on_paper(http, judged)[0]):
        assert f"Verdict: {verdict['headline']}" in text
        assert text.index("Verdict:") < text.index("Inputs")
        assert text.index("Results") < text.index("Range of validity") < text.index("Digests")
        assert "is below 4 µm: not met" in " ".join(text.replace("μ", "µ").split())
        for wanted in ("test 7", "waived: accepted in test 12", "give permissible film"):
            assert wanted in text, wanted


def test_a_verdict_that_is_not_green_has_no_green_letter(http, judged):
    page = read(http, judged).text
    assert not http.get(f"{DESIGNS}/{judged['id']}/revisions/1").json()["verdict"]["green"]
    assert 'class="verdict green"' not in page
    assert 'class="verdict bad"' in page


def test_a_limit_that_was_not_given_is_neither_met_nor_kept(http, cycle):
    design = created(http, {"name": "no limits", "steps": {"cycle": cycle}})
    text = on_screen(http, design).text
    assert "The smallest film is not below the permissible one" not in text
    assert "The largest pressure is not above" not in text
    criteria = http.get(f"{DESIGNS}/{design['id']}/revisions/1").json()["criteria"]
    assert {one["verdict"] for one in criteria if one.get("give")} == {"not_checked"}


def test_a_violated_limit_never_prints_its_opposite(http, cycle):
    limited = {**cycle, "inputs": {**cycle["inputs"], "permissible_film": "50 um"}}
    design = created(http, {"name": "too thin", "steps": {"cycle": limited}})
    for text in (on_screen(http, design).text, on_paper(http, design)[0]):
        assert "film is not below the permissible one" not in text.replace("smallest film", "film")
        assert re.search(r"minimum film thickness [\d.]+ [µμ]m is below permissible film 50 [µμ]m", text)


@pytest.mark.slow
def test_plots_stand_beside_the_results(http):
    vibration = {
        "template": "torsional_vibration",
        "version": 1,
        "inputs": example(http, "torsional_vibration", 1),
    }
    load = {"template": "bearing_load", "version": 1, "inputs": example(http, "bearing_load", 1)}
    film = {"template": "oil_film", "version": 2, "inputs": example(http, "oil_film", 2)}
    design = created(http, {"name": "plots", "steps": {"shaft": vibration, "load": load, "film": film}})
    page = read(http, design).text
    titles = (
        "Campbell diagram",
        "Polar diagram of the main load",
        "over crank angle",
        "Accuracy: median error",
    )
    for title in titles:
        assert title in page, title
    assert page.count("<svg xmlns") >= 5
    assert "style=" not in page
    assert "Campbell diagram" in on_paper(http, design)[0]
