"""A template's page: what it says of itself, and a form to try it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from fastapi import Request, Response

from app.presentation.typed import value_of
from app.web import sheet
from app.web.accuracy import table
from app.web.api import Api, Refused
from app.web.forms import OPTIONS, option_of
from app.web.pictures import pictures
from app.web.rendering import show, units_of

ABOUT = {"units"}  # of the address, beside the inputs
AT_ONCE = {"Prefer": "wait=2"}  # the page shows how the rest goes on


async def template_page(request: Request, api: Api, id: str, version: int) -> Response:
    """The page, with the answer to what the address asks; to the example, where it asks nothing."""
    path = f"/templates/{id}/versions/{version}"
    told = await api.get(path)
    typed = {name: text for name, text in request.query_params.items() if name not in ABOUT}
    asked = _asked(told, typed)
    measured = await api.find(f"{path}/accuracy")
    answer, job, faults = await _tried(api, path, asked, units_of(request))
    used = answer["inputs"] if answer else {}
    fields = sheet.of_block(told["inputs"], "", asked["inputs"], used, typed, faults)
    options = sheet.of_options(told, "", asked, typed, faults)
    return show(
        request,
        "template.html",
        status=422 if faults else 200,
        template=told,
        versions=(await api.get(f"/templates/{id}"))["items"],
        accuracy=measured,
        levels=table(measured) if measured else None,
        fields=fields,
        options=options,
        loose=sheet.loose_faults([*fields, *options], faults),
        answer=answer or (_empty(told) if job else None),
        job=job,
        pictures=pictures("", told, answer or {}),
        path_of_api=f"/api/v1{path}",
    )


def _asked(told: Mapping[str, Any], typed: Mapping[str, str]) -> dict[str, Any]:
    """The body of `evaluate` for what was typed."""
    filled = {name: text.strip() for name, text in typed.items() if text.strip()}
    chosen = {f"@{option}": option for option in OPTIONS}
    inputs = {name: value_of(text) for name, text in filled.items() if name not in chosen}
    options = {o: option_of(o, filled[name]) for name, o in chosen.items() if name in filled}
    return {"inputs": inputs if typed else told["example"], **options}


async def _tried(
    api: Api, path: str, asked: Mapping[str, Any], units: str
) -> tuple[dict[str, Any] | None, str, dict[str, str]]:
    """The answer, or the address of the job that calculates it, or what is wrong."""
    try:
        answer = await api.send(
            "POST", f"{path}/worksheet", json=asked, params={"units": units}, headers=AT_ONCE
        )
    except Refused as refused:
        if refused.status not in (413, 422, 429):
            raise
        return None, "", refused.faults or {"inputs": refused.problem["detail"]}
    return (None, answer.headers["Location"], {}) if answer.status_code == 202 else (answer.json(), "", {})


def _empty(told: Mapping[str, Any]) -> dict[str, Any]:
    """What stands in place of results while they are calculated; the page's script fills it in."""
    waiting = {"value": None, "reason": "is being calculated"}
    names = told["outputs"]["properties"]
    return {
        "outputs": dict.fromkeys(names, waiting),
        "error": dict.fromkeys(names),
        "warnings": [],
        "formulas": [],
        "level": None,
    }
