"""Checks for every route that sends a stored file, from any store."""

from mathcad_files import define, math, prime, scale
from patience import patient, until
from serving import API, created, moody

WAIT = {"Prefer": f"wait={patient(20):.0f}"}
ROUTES = ("artifact", "picture", "model", "surface", "original")


def path_of(http, route):
    """A path that sends a stored file."""
    match route:
        case "artifact":
            body = {"parameters": {"size": "61 mm"}, "artifacts": ["step"]}
            built = http.post(f"{API}/models/moody/versions/1/build", json=body, headers=WAIT).json()
            return f"{API}/artifacts/{built['artifacts']['step']}"
        case "picture":
            return f"{API}/models/moody/versions/1/picture"
        case "model":
            return f"{API}/designs/{created(http, moody('62 mm'))['id']}/model.glb"
        case "surface":
            parameters = {"diameter": "28 mm", "length": "42 mm"}
            body = {"parameters": parameters, "level": "coarse", "outputs": ["surface"]}
            path = f"{API}/models/bar/versions/1/analyses/torsion"
            return http.post(path, json=body, headers=WAIT).json()["outputs"]["surface"]["url"]
    where, headers = {"id": "stored_routes", "file": "x.mcdx"}, {"Content-Type": "application/octet-stream"}
    sheet = prime(math(define("x", scale(500, "mm"))))
    job = http.post(f"{API}/worksheets/import", params=where, content=sheet, headers=headers)
    until(lambda: http.get(job.headers["location"]).json()["state"] == "done")
    return f"{API}/worksheets/stored_routes/import/original"


def check_conditions(http, path):
    """Ask for a file whole, in part, and on conditions."""
    whole = http.get(path, headers=WAIT)
    assert whole.status_code == 200, whole.text
    etag, content = whole.headers["etag"], whole.content
    assert etag.startswith('"')
    assert whole.headers["accept-ranges"] == "bytes"

    def asked(**conditions):
        answer = http.get(path, headers={name.replace("_", "-"): value for name, value in conditions.items()})
        return answer.status_code, answer.content, answer.headers.get("etag")

    assert asked(If_None_Match=etag) == (304, b"", etag)
    assert asked(If_None_Match=f'"other", W/{etag}', Range="bytes=0-9") == (304, b"", etag)
    assert asked(If_None_Match='"other"') == (200, content, etag)
    assert asked(Range="bytes=10-29") == (206, content[10:30], etag)
    assert asked(Range="bytes=-7", If_Range=etag) == (206, content[-7:], etag)
    assert asked(Range="bytes=10-29", If_Range='"other"') == (200, content, etag)
    assert asked(Range=f"bytes={len(content)}-")[0] == 416
