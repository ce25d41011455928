"""The error that the client raises when the service refuses a request."""

from __future__ import annotations

from collections.abc import Mapping

import httpx
from pydantic import JsonValue

from app.schemas.problems import Fault
from app.schemas.problems import Problem as Described


class Problem(Exception):
    """A problem (RFC 9457): the service refused a request, or a job failed.

    Attributes
    ----------
    status
        The HTTP status.
    body
        The problem as plain JSON values.
    described
        The problem as a model.
    """

    def __init__(self, status: int, body: Mapping[str, JsonValue]) -> None:
        self.status, self.body = status, dict(body)
        blank = {"type": "about:blank", "title": "", "status": status, "detail": ""}
        self.described = Described.model_validate({**blank, **self.body})
        super().__init__(f"{status} {self.described.title}: {self.described.detail}")

    @property
    def errors(self) -> list[Fault]:
        """Return every wrong input by name, if there are several."""
        return self.described.errors

    @classmethod
    def of(cls, response: httpx.Response) -> Problem:
        """Return the problem in a response; the error page of a proxy also becomes a problem."""
        try:
            return cls(response.status_code, response.json())
        except ValueError:  # not JSON, or not a problem
            return cls(response.status_code, {"title": response.reason_phrase, "detail": response.text[:500]})


def checked(response: httpx.Response) -> httpx.Response:
    """Return a response unchanged.

    Raises
    ------
    Problem
        If it refuses the request.
    """
    if response.is_error:
        raise Problem.of(response)
    return response
