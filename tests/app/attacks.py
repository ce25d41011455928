"""Requests to each route that succeed if the role allows them; `test_attack.py` uses them.

A call that changes or ends an object gets a copy: a function of the scene and of who sends the request, which
gives names in the path, and what else the request has.
"""

from dataclasses import dataclass, field

from attacked import BAR, BINARY, BUILD, GRID, document
from patience import until
from serving import API, created
from sheets import BUSH, WIDER, drafted, fresh, step
from study_helpers import begun, done

DESIGN, REVISION = f"{API}/designs/{{id}}", f"{API}/designs/{{id}}/revisions/{{number}}"
SHEET, PRINCIPAL = f"{API}/worksheets/{{id}}", f"{API}/principals/{{id}}"
VERSION, MODEL = f"{API}/templates/{{id}}/versions/{{number}}", f"{API}/models/{{id}}/versions/{{number}}"
EXACT = {"parameters": {"length": "2 mm"}}
LENGTH = {"unknown": "length", "between": ["1 mm", "4 mm"], "target": {"double.twice_the_length": "5 mm"}}
GIVEN = {
    "inputs": {},
    "unknown": "length",
    "between": ["1 mm", "4 mm"],
    "target": {"twice_the_length": "5 mm"},
}
FILM = {"inputs": {
    "bearing_diameter": "48 mm", "bearing_width": "18 mm", "diametral_clearance": "0.055 mm",
    "dynamic_viscosity": "18 mPa*s", "relative_eccentricity": 0.88, "speed": "5000 rpm",
}}  # fmt: skip


@dataclass(frozen=True)
class Call:
    """A request: names in the path, and arguments of httpx."""

    json: object = None
    names: dict = field(default_factory=dict)
    copy: object = None
    more: dict = field(default_factory=dict)

    @property
    def body(self):
        """The body as arguments of httpx; empty without one."""
        return {} if self.json is None else {"json": self.json}

    def arguments(self, scene, who):
        """Names in the path, and what is sent by whom; a copy is made of what the call would change."""
        names, more = self.copy(scene, who) if self.copy else ({}, {})
        return {**self.names, **names}, {**self.body, **self.more, **more}


def match(tag):
    return {"headers": {"If-Match": tag}}


def maker(scene, who):
    """Whoever attacks if that may make things, else the author."""
    return scene.http[who if who in ("author", "checker") else "author"]


def design(scene, who):
    owned = created(maker(scene, who), document(**EXACT, variants={}, models={}))
    return {"id": owned["id"]}, match(f'"{owned["revision"]}"')


def to_choose(scene, who):
    design = created(maker(scene, who), document(variants={}, models={}))
    return {"id": done(scene.author, design, **GRID)["id"]}, match(f'"{design["revision"]}"')


def to_sign(scene, who):
    id = created(maker(scene, who), document())["id"]
    return {"id": id}, match(scene.author.get(f"{API}/designs/{id}/revisions/1/approvals").headers["etag"])


def comment(scene, who):
    path = scene.path(f"{REVISION}/comments")
    return {"comment": scene.author.post(path, json={"text": "why?"}).json()["id"]}, {}


def of_design(scene, who):
    return {}, {"json": {"design": scene.ids["designs"], **GRID}}


def study(scene, who):
    return {"id": done(scene.author, {"id": scene.ids["designs"]}, **GRID)["id"]}, {}


def draft(scene, who):
    sheet = drafted(scene.author)
    return {"id": sheet["id"]}, match(f'"{sheet["edit"]}"')


def new_sheet(scene, who):
    return {}, {"json": {"text": BUSH, "id": fresh("attacked")}}


def sheet_file(scene, who):
    return {}, {"params": {"id": fresh("attacked")}, "content": scene.sheet, "headers": BINARY}


def model_file(scene, who):
    step = step_file(scene, who)[1]["content"]
    return {}, {"params": {"id": fresh("attacked")}, "content": step, "headers": BINARY}


def brought(scene, who):
    """A STEP file that the author brought as a model, once."""
    if "brought" not in scene.ids:
        scene.ids["brought"] = name = fresh("brought")
        more = model_file(scene, who)[1]
        job = scene.author.post(f"{API}/models/import", **{**more, "params": {"id": name}})
        until(lambda: scene.author.get(job.headers["location"]).json()["state"] == "done")
    return {"id": scene.ids["brought"]}, {}


def tested(scene, who):
    names, _ = draft(scene, who)
    digest = step(scene.author, names["id"], "test")["digest"]
    return names, {"json": {"reviewer": "B. Klein", "digest": digest}}


def reviewed(scene, who):
    names, body = tested(scene, who)
    step(scene.http["checker"], names["id"], "review", **body["json"])
    return names, {}


def released(scene, who):
    names, _ = reviewed(scene, who)
    step(scene.http["checker"], names["id"], "release")
    return names, {}


def waiting_job(scene, who):
    """A job of whoever asks, of a kind that nothing runs."""
    jobs, owner, payload = scene.services.jobs, f"principal:{scene.principals[who]}", {"of": fresh()}
    return {
        "id": scene.services.database.write(
            lambda session: jobs.enqueue(session, "of_no_kind", payload, client=owner)
        )
    }, {}


def long_study(scene, who):
    """A study that takes its time."""
    sample = {"method": "sample", "points": 1_000_000, "vary": GRID["vary"], "outputs": GRID["outputs"]}
    return {"id": begun(scene.http[who], {"id": scene.ids["designs"]}, **sample)["id"]}, {}


def oneself(scene, who):
    return {"id": scene.principals[who]}, {}


def own_key(scene, who):
    key, _ = scene.team.identity.add_key(scene.principals[who])
    return {"id": scene.principals[who], "prefix": key.prefix}, {}


def new_principal(scene, who):
    return {}, {"json": {"name": fresh("somebody"), "roles": ["viewer"]}}


def somebody(scene, who):
    return {"id": scene.team.identity.add(fresh("somebody"), ["viewer"]).id}, {}


def step_file(scene, who):
    path = scene.path(f"{API}/artifacts/{{sha256}}")
    return {}, {"content": scene.author.get(path).content, "headers": {"Content-Type": "model/step"}}


OF_MODEL = {"id": "moody"}
CALLS = {
    f"POST {VERSION}/evaluate": Call({"inputs": {"length": "2 mm"}}),
    f"POST {VERSION}/solve": Call(GIVEN),
    f"POST {VERSION}/worksheet": Call({"inputs": {"length": "2 mm"}}),
    f"GET {VERSION}/evaluate.csv": Call(more={"params": {"length": "2 mm"}}),
    f"POST {VERSION}/impact": Call({}),
    f"POST {API}/film-pressure": Call(FILM),
    f"POST {API}/curves": Call(more={"content": b"a [mm]\n1\n2\n", "headers": {"Content-Type": "text/csv"}}),
    f"POST {API}/worksheets/import": Call(copy=sheet_file),
    f"POST {API}/models/import": Call(copy=model_file),
    f"GET {MODEL}/origin": Call(copy=brought),
    f"GET {MODEL}/original": Call(copy=brought),
    f"POST {API}/worksheets/check": Call({"text": BUSH}),
    f"POST {API}/worksheets": Call(copy=new_sheet),
    f"PATCH {SHEET}": Call({"text": WIDER}, copy=draft),
    f"DELETE {SHEET}": Call(copy=draft),
    f"POST {SHEET}/test": Call(copy=draft),
    f"POST {SHEET}/review": Call(copy=tested),
    f"POST {SHEET}/release": Call(copy=reviewed),
    f"POST {SHEET}/withdraw": Call({"reason": "wrong"}, copy=released),
    f"POST {API}/designs": Call(document(**EXACT, variants={}, models={})),
    f"PATCH {DESIGN}": Call({"parameters": {"length": "3 mm"}}, copy=design),
    f"DELETE {DESIGN}": Call(copy=design),
    f"POST {DESIGN}/preview": Call({"parameters": {"length": "3 mm"}}),
    f"POST {DESIGN}/auto-map": Call(),
    f"POST {DESIGN}/copy": Call(),
    f"POST {REVISION}/restore": Call(copy=design),
    f"POST {DESIGN}/decide": Call({}),
    f"POST {DESIGN}/solve": Call(LENGTH),
    f"POST {DESIGN}/tolerance": Call({}),
    f"POST {API}/answer": Call({"design": "shell", "free": {"ratio": {"between": ["0.3", "0.9"]}}}),
    f"POST {DESIGN}/labels": Call({"add_tags": ["attacked"]}),
    f"GET {DESIGN}/compare": Call(more={"params": {"revision": "1", "with": "1"}}),
    f"PUT {DESIGN}/variants": Call({"variants": {"small": {"length": "9 mm"}}}, copy=design),
    f"POST {API}/studies": Call(copy=of_design),
    f"POST {API}/studies/estimate": Call(copy=of_design),
    f"DELETE {API}/studies/{{id}}": Call(copy=study),
    f"POST {API}/studies/{{id}}/choose": Call({"row": 1}, copy=to_choose),
    f"GET {VERSION}/accuracy": Call(names={"id": "oil_film"}),
    f"GET {API}/models/{{id}}": Call(names=OF_MODEL),
    f"GET {MODEL}": Call(names=OF_MODEL),
    f"GET {MODEL}/picture": Call(names=OF_MODEL),
    f"POST {MODEL}/build": Call(BUILD, names=OF_MODEL),
    f"POST {MODEL}/analyses/{{kind}}": Call(BAR, names={"id": "bar", "kind": "torsion"}),
    f"POST {API}/verify": Call(copy=step_file),
    f"DELETE {API}/jobs/{{id}}": Call(copy=waiting_job),
    f"POST {API}/principals": Call(copy=new_principal),
    f"POST {PRINCIPAL}": Call({"roles": ["viewer"]}, copy=somebody),
    f"GET {PRINCIPAL}/usage": Call(copy=oneself),
    f"GET {PRINCIPAL}/keys": Call(copy=oneself),
    f"POST {PRINCIPAL}/keys": Call({"name": "mine"}, copy=oneself),
    f"DELETE {PRINCIPAL}/keys/{{prefix}}": Call(copy=own_key),
    f"POST {REVISION}/approvals": Call({"step": "calculated"}, copy=to_sign),
    f"POST {REVISION}/comments": Call({"text": "why?"}),
    f"POST {REVISION}/comments/{{comment}}/resolve": Call(copy=comment),
}
"""By method and path; a route that is not here is asked without more."""
