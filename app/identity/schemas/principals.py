"""Request and response schemas for principals, keys, limits and usage."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from app.schemas.answers import Answer, Page
from app.schemas.bounds import Bounded
from app.schemas.texts import LINE

Role = Literal["viewer", "author", "checker", "admin"]
Name = Annotated[str, Field(min_length=1, max_length=100, pattern=LINE)]
Roles = Annotated[list[Role], Field(max_length=4)]


class Author(Answer):
    """The author of an action."""

    id: str
    name: str


class Limits(Answer):
    """The limits of a principal."""

    processor_seconds: float = Field(
        description="processor time of requests to one server, while others use that server [s/min]"
    )
    storage_mb: float = Field(
        description="content that the principal was the first to store, even if deleted: files of builds, "
        "surfaces of analyses, imported files, tables and rows of studies, texts of worksheets [MiB]"
    )
    calculation_seconds: float = Field(description="run time of jobs per day (UTC) [s]")
    queued_jobs: int = Field(description="largest number of waiting jobs")


class Usage(Answer):
    """The usage of a principal today (UTC), and the amount of its stored content."""

    requests: int = Field(description="requests today; counted every few seconds")
    jobs: int = Field(description="jobs that were queued today")
    calculation_seconds: float = Field(description="run time of jobs today [s]")
    storage_mb: float = Field(description="total stored content [MiB]")
    queued_jobs: int = Field(description="jobs that wait now")
    limits: Limits | None = Field(description="limits; null if nothing is limited")


class Principal(Answer):
    """A person or a service that may use the interface."""

    id: str
    name: str
    kind: Literal["person", "service"]
    roles: list[Role]
    disabled: str | None = Field(description="time since which it is disabled; null if it is not")
    created: str


class PrincipalList(Page[Principal]):
    """A page of principals, oldest first."""


class Me(Answer):
    """The principal of the request, with its roles and usage."""

    id: str
    name: str
    kind: Literal["person", "service"]
    roles: list[Role] = Field(description="roles that the key or session allows")
    usage: Usage


class Key(Answer):
    """A key without its secret, of which the service stores only the hash."""

    prefix: str = Field(description="the public part of the key, which identifies it")
    name: str
    scopes: list[Role] = Field(description="roles that the key is limited to; if empty, all of its principal")
    expires: str | None
    revoked: str | None
    made_by: str | None = Field(description="prefix of the key that created this one; this key ends with it")
    created: str


class KeyList(Page[Key]):
    """The keys of a principal, oldest first."""


class NewKey(Key):
    """A newly created key; only this answer contains its secret."""

    key: str


class PrincipalIn(Bounded):
    """A new principal."""

    model_config = ConfigDict(
        extra="forbid", json_schema_extra={"examples": [{"name": "Ada Weber", "roles": ["author"]}]}
    )

    name: Name
    roles: Roles
    kind: Literal["person", "service"] = "person"


class LimitsIn(Bounded):
    """The principal's own limits; null means the limit of the settings."""

    model_config = ConfigDict(extra="forbid")

    processor_seconds: float | None = Field(None, gt=0, le=1e6, allow_inf_nan=False)
    storage_mb: float | None = Field(None, ge=0, le=1e9, allow_inf_nan=False)
    calculation_seconds: float | None = Field(None, ge=0, le=1e7, allow_inf_nan=False)
    queued_jobs: int | None = Field(None, ge=1, le=10**6)


class PrincipalPatch(Bounded):
    """A change of a principal."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"examples": [{"disabled": True}]})

    name: Name | None = None
    roles: Roles | None = None
    disabled: bool | None = None
    limits: LimitsIn | None = None


class KeyIn(Bounded):
    """A new key."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"examples": [{"expires_days": 90}]})

    name: Annotated[str, Field(max_length=100)] = ""
    scopes: Roles = Field([], description="roles to limit the key to; if empty, all of its principal")
    expires_days: float | None = Field(None, gt=0, le=36500, allow_inf_nan=False)
