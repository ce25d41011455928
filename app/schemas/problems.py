"""Problems (RFC 9457): the response to every refused request, and how routes declare theirs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NotRequired, TypedDict

from fastapi.params import Depends
from pydantic import BaseModel, ConfigDict, Field
from pydantic.config import JsonDict
from starlette.responses import Response

MEDIA_TYPE = "application/problem+json"


class Fault(BaseModel):
    """One fault of a request."""

    name: str = Field(description="the input, parameter or part of the request")
    code: str
    detail: str = Field(description="what is wrong, in which unit, and how to correct it")
    also: list[str] = Field([], description="other names that the detail refers to")


class Problem(BaseModel):
    """The reason for a refusal; some kinds have further fields, such as the range that a target can reach."""

    model_config = ConfigDict(extra="allow")

    type: str = Field(description="link to the meaning of this kind of problem and its remedy")
    title: str
    status: int
    detail: str
    request_id: str | None = Field(
        None, description="id of the request, as in the header X-Request-ID and in the log"
    )
    errors: list[Fault] = Field([], description="all faults of the request, if there are several")


class ProblemKind(BaseModel):
    """The meaning of a kind of problem."""

    slug: str
    status: int
    title: str
    remedy: str


PROBLEM_CONTENT: JsonDict = {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/Problem"}}}

MEANINGS = {
    400: "the host or the path cannot be read",
    401: "no valid key or session came, where the service asks for one",
    403: (
        "the role is missing, the object is another's, authors review their own worksheet, or a page of "
        "another site sent the request"
    ),
    404: "there is nothing of this name, number or version",
    406: "the answer does not fit the form that Accept names",
    408: "the body came too slowly",
    409: "the state of the job, the design, its approval or the worksheet does not allow it",
    410: "the file is lost and cannot be made again under its hash; the problem says why",
    412: "the design, its approval or the worksheet has changed since the state that If-Match names",
    413: "the body or the answer is too large",
    415: "the content type is not one that the path takes",
    422: "an input is wrong; `errors` names each one",
    428: "a change needs If-Match",
    429: "too much is waiting; retry after `Retry-After`",
    431: "the headers are too large",
    503: "the service stops, its storage fails, or a file is being made again; retry after `Retry-After`",
    507: "the disk of the service has no room for the file",
}


Responses = dict[int | str, dict[str, object]]
"""Declared answers of a route by status, in the form that FastAPI needs."""


class RouteOptions(TypedDict):
    """Options that the routes of several paths share."""

    dependencies: NotRequired[Sequence[Depends]]
    response_class: type[Response]
    responses: Responses


def refusals(*statuses: int) -> Responses:
    """Return the `responses` of a route that declare its problems."""
    return {status: {"description": MEANINGS[status], "content": PROBLEM_CONTENT} for status in statuses}
