"""Response schemas for the state of the service: alive, and ready."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from app.schemas.answers import Answer


class Health(Answer):
    """The process is alive."""

    status: Literal["ok"]


class Ready(Answer):
    """The service is ready for work."""

    status: Literal["ready"]
    checks: dict[str, str] = Field(description="`ok` by check")
