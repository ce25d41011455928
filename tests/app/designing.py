"""Requests to a service for tests of designs."""

from serving import API, moody, paper, revision

DESIGNS = f"{API}/designs"


def bore(http, design):
    """The inner diameter [mm] as the service read it back from the STEP file."""
    answer = http.get(f"{DESIGNS}/{design['id']}/measurements").json()
    assert answer["model"]["dimensions"]["inner_diameter"]["unit"] == "mm"
    return answer["model"]["dimensions"]["inner_diameter"]["value"]


def build_of(http, design, model="model"):
    return revision(http, design)["models"][model]["build"]


def jobs_of(http, design):
    listed = http.get(f"{API}/jobs", params={"limit": 500}).json()["items"]
    return [job for job in listed if job["design"] == design["id"]]


def feedback(mass_per_kg="0.5 mm/kg", **iteration):
    """A block whose size follows from its own mass."""
    document = moody("= size")
    document["parameters"] = {"size": f"= 20 mm + model.mass * {mass_per_kg}"}
    return {**document, "iterations": [{"through": "model.mass", "start": "0.1 kg", **iteration}]}


def weighed(bore="31 mm"):
    """A film whose load is the weight of the model [N], times 1000."""
    document = paper(model={"id": "ball_bearing", "parameters": {"inner_diameter": bore}})
    document["steps"]["film"]["inputs"]["radial_load"] = "= model.mass * 9.81 m/s**2 * 1000"
    document["steps"]["film"]["inputs"]["bearing_diameter"] = "48 mm"
    return document


def created_by(answer):
    assert answer.status_code == 201, answer.text
    return answer.json()


def size_of(http, design):
    answer = http.get(f"{DESIGNS}/{design['id']}/measurements").json()
    return answer["model"]["dimensions"]["size"]["value"]
