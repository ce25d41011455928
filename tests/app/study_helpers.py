"""Studies for tests: a design of one exact formula, and one of a real film."""

import httpx
from patience import patient, until
from serving import API, created
from sqlalchemy import create_engine, text

TWICE = {
    "name": "twice",
    "parameters": {"length": "2 mm"},
    "steps": {"double": {"template": "double", "version": 1, "inputs": {"length": "= length"}}},
}
OUT = "double.twice_the_length"

FILM = {
    "name": "main bearing",
    "parameters": {"diameter": "48 mm", "width": "18 mm", "clearance": "0.055 mm"},
    "steps": {
        "film": {
            "template": "oil_film",
            "version": 2,
            "outputs": ["minimum_film_thickness", "power_loss"],
            "inputs": {
                "radial_load": "25 kN",
                "bearing_diameter": "= diameter",
                "bearing_width": "= width",
                "speed": "5000 rpm",
                "diametral_clearance": "= clearance",
                "supply_temperature": "80 degC",
            },
        }
    },
    "criteria": {"thick_enough": {"require": "film.minimum_film_thickness >= 1.8 um"}},
}
LENGTHS = {"length": {"between": ["0 mm", "10 mm"]}}
THICKNESS, LOSS = "film.minimum_film_thickness", "film.power_loss"
CLEARANCE = {"clearance": {"between": ["0.03 mm", "0.09 mm"]}}
ENDED = ("done", "failed", "cancelled")


def asked(http, design, **body):
    """The answer to the request that begins a study."""
    return http.post(f"{API}/studies", json={"design": design["id"], **body})


def begun(http, design, **body):
    answer = asked(http, design, **body)
    assert answer.status_code == 202, answer.text
    return answer.json()


def ended(http, study, seconds=120.0):
    ask = lambda: http.get(f"{API}/studies/{study['id']}").json()  # noqa: E731
    return until(ask, lambda now: now["state"] in ENDED, patient(seconds))


def done(http, design, **body):
    """A study once it has done its work."""
    study = ended(http, begun(http, design, **body))
    assert study["state"] == "done", study
    return study


def rows(http, study, **query):
    answer = http.get(f"{API}/studies/{study['id']}/rows", params={"limit": 500, **query})
    assert answer.status_code == 200, answer.text
    return answer.json()


def content(http, study, kind, **query):
    answer = http.get(f"{API}/studies/{study['id']}/rows.{kind}", params=query)
    assert answer.status_code == 200, answer.text
    return answer.content


def new_design(http, document):
    return created(http, document)


def queried(data, query, **values):
    """The answer of a data folder's database to a query, whether a service runs on it or not."""
    engine = create_engine(f"sqlite:///{data}/crankwright.sqlite")
    with engine.connect() as connection:
        answer = [tuple(row) for row in connection.execute(text(query), values)]
    engine.dispose()
    return answer


def chunks(data, study):
    """The chunks as they were recorded: (number, rows, sha256)."""
    query = "SELECT number, rows, sha256 FROM study_chunk WHERE study_id = :id ORDER BY number"
    return queried(data, query, id=study["id"])


def connected(url):
    return httpx.Client(base_url=url, timeout=90, trust_env=False)
