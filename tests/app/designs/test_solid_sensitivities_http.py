"""A client asks for sensitivities through a solid; a calculation process computes the slopes of the solid."""

import pytest
from designing import weighed
from serving import API, created, ended


def test_an_explanation_has_slopes_through_the_solid(http):
    document = weighed("31.25 mm")
    document["model"]["parameters"] |= {"outer_diameter": "62 mm", "width": "16.3 mm"}
    document["criteria"] = {"light": {"require": "model.mass <= 1 kg"}}
    design = created(http, document)
    asked = f"{API}/designs/{design['id']}/explain/criteria.light"
    answer = http.get(asked, headers={"Prefer": "wait=0"})
    job = ended(http, answer)
    assert job["state"] == "done", job
    chain = http.get(job["result"]).json()
    slopes = {item["name"]: item for item in chain["sensitivities"]}
    assert slopes.keys() == {"model.inner_diameter", "model.outer_diameter", "model.width"}
    assert all(item["slope"] and not item.get("reason") for item in slopes.values())
    assert sum(item["elasticity"] for item in slopes.values()) == pytest.approx(3, rel=1e-6)
    assert slopes["model.inner_diameter"]["helps"] == "increase"
