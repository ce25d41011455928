"""On random designs, no sentence on a page, in a report or in a refusal contradicts its own numbers."""

import random
from html.parser import HTMLParser

import pytest
from seeds import seeded
from serving import API
from test_true_sentences import cheap, random_design
from true_numbers import TRUE_OF, comparisons

HTML = {"Accept": "text/html"}
HOLDS = {"not below": True, "not above": True, "below": False, "above": False}


class Texts(HTMLParser):
    """The texts of a page, one for each node."""

    def __init__(self):
        super().__init__()
        self.texts, self.hidden = [], 0

    def handle_starttag(self, tag, attrs):
        self.hidden += tag in ("script", "style", "math", "svg")

    def handle_endtag(self, tag):
        self.hidden -= tag in ("script", "style", "math", "svg")

    def handle_data(self, data):
        if not self.hidden and data.strip():
            self.texts.append(" ".join(data.split()))


def assert_true(text):
    """Comparisons of a text are true of their numbers, a verdict behind one agrees; how many there are."""
    count = 0
    for one, relation, other, part in comparisons(text):
        assert TRUE_OF[relation](one, other), text
        verdict = text.partition(f"{part}: ")[2]
        if verdict.startswith("not met"):
            assert not HOLDS[relation], text
        elif verdict.startswith("met"):
            assert HOLDS[relation], text
        count += 1
    return count


def check(http, count, seed):
    rng, classes = random.Random(seed), cheap()
    compared = 0
    for number in range(count):
        answer = http.post(
            f"{API}/designs", json=random_design(classes, rng, number), headers={"Prefer": "wait=30"}
        )
        if answer.status_code == 422:
            compared += sum(assert_true(error["detail"]) for error in answer.json()["errors"])
            continue
        assert answer.status_code == 201, answer.text
        place = f"/designs/{answer.json()['id']}"
        for path in (place, f"/api/v1{place}/report.html"):
            parser = Texts()
            parser.feed(http.get(path, headers=HTML).text)
            compared += sum(map(assert_true, parser.texts))
    return compared


def test_property_pages_and_reports_contradict_no_number(http):
    assert check(http, 3, seeded(38)) > 3


@pytest.mark.slow
def test_property_pages_and_reports_of_500_designs_contradict_no_number(http):
    assert check(http, 500, seeded(39)) > 1500
