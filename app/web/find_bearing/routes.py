"""The page that finds a plain bearing: requirements in, the bearing and its proof out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple
from urllib.parse import urlencode

from fastapi import APIRouter, Depends, Request, Response

from app.answers.bodies import AnswerIn
from app.answers.schemas import DesignAnswer
from app.answers.service import question_of
from app.presentation.input_text import value_of
from app.web.shared.answers import AnswerOrJob, stored
from app.web.shared.forms import fields as form_fields
from app.web.shared.forms import forms_only
from app.web.shared.responses import go, show, units_of
from app.web.shared.services import PageServices, ThePageServices
from app.web.solve.solution import PATIENCE, Reply, replied

PATH = "/find-bearing"
FILM, WIDTH, CLEARANCE = "film.minimum_film_thickness", "film.bearing_width", "film.diametral_clearance"

router = APIRouter(include_in_schema=False)
forms = APIRouter(include_in_schema=False, dependencies=[Depends(forms_only)])


class FormField(NamedTuple):
    """A field of the form: its label, the value of the paper, and the input that it sets."""

    words: str
    usual: str
    place: str = ""


FIELDS = {
    "load": FormField("Load", "25 kN", "film.radial_load"),
    "speed": FormField("Speed", "5000 rpm", "film.speed"),
    "diameter": FormField("Bearing diameter", "48 mm", "film.bearing_diameter"),
    "inlet": FormField("Oil at the inlet", "80 degC", "film.oil_inlet_temperature"),
    "outlet": FormField("Oil at the outlet", "87.762 degC", "film.oil_outlet_temperature"),
    "film": FormField("Smallest film at least", "3 um"),
    "width_low": FormField("Width from", "15 mm"),
    "width_high": FormField("Width to", "40 mm"),
    "width_step": FormField("Width in steps of", "0.5 mm"),
    "clearance_low": FormField("Diametral clearance from", "30 um"),
    "clearance_high": FormField("Diametral clearance to", "120 um"),
}


CHOSEN = {WIDTH: "Width", CLEARANCE: "Diametral clearance"}
"""The values that the service chooses, in words."""


def typed_in(texts: Mapping[str, str]) -> dict[str, str]:
    """Return the text of each field; the values of the paper where nothing was sent."""
    return {name: texts.get(name, one.usual).strip()[:200] for name, one in FIELDS.items()}


def body_of(typed: Mapping[str, str], *, save: bool = False) -> dict[str, object]:
    """Return the form as a request for an answer; an empty step leaves the width continuous."""
    width: dict[str, object] = {"between": [value_of(typed["width_low"]), value_of(typed["width_high"])]}
    if typed["width_step"]:
        width["step"] = value_of(typed["width_step"])
    clearance = [value_of(typed["clearance_low"]), value_of(typed["clearance_high"])]
    return {
        "design": "shell",
        "with": {
            one.place: value_of(typed[name]) for name, one in FIELDS.items() if one.place and typed[name]
        },
        "free": {WIDTH: width, CLEARANCE: {"between": clearance}},
        "set_aside": [WIDTH],
        "require": [f"{FILM} >= {typed['film']}"],
        "minimise": "film.power_loss",
        **({"save": True} if save else {}),
    }


@router.get(PATH)
async def find_bearing(request: Request, services: ThePageServices) -> Response:
    """Return the form, with the answer once it was sent; the address holds the request."""
    sent = dict(request.query_params)
    typed, job, reply = typed_in(sent), sent.get("job", ""), Reply[DesignAnswer]()
    if sent:
        reply = await replied(
            stored(services, job, DesignAnswer) if job else _answered(request, services, body_of(typed))
        )
    if reply.job and not job:
        return go(f"{PATH}?{urlencode({**typed, 'job': reply.job})}")
    if reply.answer is not None and reply.answer.saved is not None:
        return go(f"/designs/{reply.answer.saved.design}")
    return show(
        request,
        "find_bearing/find_bearing.html",
        fields=FIELDS,
        chosen=CHOSEN,
        typed=typed,
        answer=reply.answer,
        refusal=reply.refusal,
        job=reply.job,
    )


@forms.post(PATH)
async def save_bearing(request: Request, services: ThePageServices) -> Response:
    """Save the bearing as a new design, and go to its page; go to the job if it takes longer."""
    typed = typed_in(await form_fields(request))
    reached = await _answered(request, services, body_of(typed, save=True))
    if reached.answer is not None and reached.answer.saved is not None:
        return go(f"/designs/{reached.answer.saved.design}")
    more = {"job": reached.job} if reached.job else {}
    return go(f"{PATH}?{urlencode({**typed, **more})}")


async def _answered(
    request: Request, services: PageServices, body: Mapping[str, object]
) -> AnswerOrJob[DesignAnswer]:
    """Return the answer, or the job that calculates it if it takes longer than the page waits."""
    read = services.read(AnswerIn, body)
    units, once = units_of(request), services.once
    asked = await services.run(question_of, read, units, services.client, once, None, services.catalogues)
    answer, job = await services.calculate(PATIENCE, services.answers.answer, asked, services.client)
    return AnswerOrJob(answer, job or "")
