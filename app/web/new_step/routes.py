"""The form for a new step; it is empty, so that no example value is mistaken for the user's.

It creates a design, or adds a step to one. Nothing is saved until the form is complete.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from urllib.parse import urlencode

from fastapi import APIRouter, Request, Response
from pydantic import JsonValue

from app.catalogue.routes.templates import Number, show_template
from app.catalogue.schemas.library import LibraryTable
from app.catalogue.schemas.templates import Template
from app.presentation.input_text import value_of
from app.web.shared import sheet
from app.web.shared.blocks import Refusal
from app.web.shared.forms import LIMITS, OPTIONS, option_of
from app.web.shared.limits import library, limit_fields, with_rows
from app.web.shared.paths import Id
from app.web.shared.responses import show
from app.web.shared.services import PageServices, ThePageServices

_NUMBER = re.compile(r"[0-9]{1,6}")
FIELDS = ("design_name", "name", "template", "model")
"""Fields of the form other than the values of the step."""


@dataclass(frozen=True)
class NewStep:
    """A new step: its name, its template, and the typed texts of its fields."""

    name: str
    template: Template
    typed: Mapping[str, str]
    tables: Sequence[LibraryTable] = ()

    @property
    def is_filled(self) -> bool:
        """Return whether the user typed anything into the fields."""
        return any([*self._tails(".").values(), *self._limits().values()])

    def plain(self) -> dict[str, JsonValue]:
        """Return the step as the interface accepts it."""
        step: dict[str, JsonValue] = {"template": self.template.id, "version": self.template.version}
        step["inputs"] = {tail: value_of(text) for tail, text in self._tails(".").items() if text}
        if limits := {tail: value_of(text) for tail, text in self._limits().items() if text}:
            step["limits"] = limits
        options = {option: self.typed.get(f"{self.name}@{option}", "").strip() for option in OPTIONS}
        return step | {option: option_of(option, text) for option, text in options.items() if text}

    def fields(self, faults: Mapping[str, str]) -> list[sheet.Field]:
        """Return the fields of the step's inputs, empty or as typed."""
        fields = sheet.of_block(self.template.inputs, self.name, {}, {}, self.typed, faults)
        return with_rows(fields, self.tables)

    def limits(self, faults: Mapping[str, str]) -> list[sheet.Field]:
        """Return the fields for limits of the step's criteria."""
        return limit_fields(self.template, self.name, {}, self.typed, faults, self.tables)

    def options(self, faults: Mapping[str, str]) -> list[sheet.Field]:
        """Return the fields that choose the accuracy of the step."""
        return sheet.of_options(self.template, self.name, {}, self.typed, faults)

    def _limits(self) -> dict[str, str]:
        """Return the typed limits by name."""
        return self._tails(f"@{LIMITS}")

    def _tails(self, sign: str) -> dict[str, str]:
        """Return the typed texts, by the part of the control's name that follows a sign."""
        begins = f"{self.name}{sign}"
        return {
            key.removeprefix(begins): text.strip()
            for key, text in self.typed.items()
            if key.startswith(begins)
        }


async def new_step(services: PageServices, typed: Mapping[str, str]) -> NewStep:
    """Return the step that a form describes; an unnamed step gets the name of its template."""
    id, version = versioned(typed.get("template", ""))
    number = services.read(Number, version)
    template = await services.run(show_template, id, number, services.catalogues)
    return NewStep(typed.get("name", "").strip() or template.id, template, typed, await library(services))


def versioned(chosen: str) -> tuple[str, int | str]:
    """Return the id and version in a text such as `oil_film/2`."""
    id, _, version = chosen.partition("/")
    return id, int(version) if _NUMBER.fullmatch(version) else "latest"


def beside(typed: Mapping[str, str]) -> dict[str, str]:
    """Return the texts of a form that are not values of the step."""
    return {name: typed[name] for name in FIELDS if typed.get(name)}


def address(base: str, typed: Mapping[str, str]) -> str:
    """Return the address of the form."""
    return f"{base}?{urlencode(beside(typed))}"


def step_page(
    request: Request,
    step: NewStep,
    action: str,
    hidden: Mapping[str, str],
    refusal: Refusal | None = None,
    notice: str | None = None,
    design: str = "",
) -> Response:
    """Return the empty form, or a refused form with its texts and faults."""
    faults = refusal.faults if refusal else {}
    fields, options, limits = step.fields(faults), step.options(faults), step.limits(faults)
    return show(
        request,
        "new_step/new_step.html",
        status=422 if refusal else 200,
        step=step,
        action=action,
        hidden=hidden,
        fields=fields,
        options=options,
        limits=limits,
        design=design,
        loose=sheet.loose_faults([*fields, *options, *limits], faults),
        notice=notice,
    )


router = APIRouter(include_in_schema=False)


@router.get("/designs/new")
async def new_design(request: Request, services: ThePageServices) -> Response:
    """Return the page with an empty form for a new design's first step."""
    typed = dict(request.query_params)
    step = await new_step(services, typed)
    hidden = {"design_name": "new design", **beside(typed)}
    return step_page(request, step, "/designs", hidden)


@router.get("/designs/{id}/steps/new")
async def another_step(id: Id, request: Request, services: ThePageServices) -> Response:
    """Return the page with an empty form for another step of a design."""
    typed = dict(request.query_params)
    step, design = await new_step(services, typed), await services.run(services.designs.show, id)
    hidden = {**beside(typed), "add": "template", "revision": str(design.revision)}
    return step_page(request, step, f"/designs/{id}/blocks", hidden, design=id)
