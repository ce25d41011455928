"""The state of the service: whether it is alive, and whether it is ready."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from app.schemas.answers import Answer


class Health(Answer):
    """The process is alive."""

    status: Literal["ok"]


class Ready(Answer):
    """The service can do its work now."""

    status: Literal["ready"]
    checks: dict[str, str] = Field(description="`ok` by check")
