"""Response schemas for the audit: who did what, and the chain of sealed rows."""

from __future__ import annotations

from pydantic import ConfigDict, Field

from app.schemas.answers import Answer, Page


class AuditEntry(Answer):
    """One change, recorded in the same transaction as the change itself."""

    model_config = ConfigDict(from_attributes=True)

    id: str
    at: str
    principal: str = Field(description="id of the principal that made the change")
    name: str = Field(description="name of the principal at that time")
    action: str = Field(description="the object's kind and the verb, such as `design.create`")
    object: str = Field(description="path of the object below `/api/v1/`")
    digest: str | None = Field(description="SHA-256 of the written or signed content, if any")
    seq: int | None = Field(description="number in the chain; null until the row is sealed, within a second")
    previous: str | None = Field(description="hash of the previous row; null for the first row")
    hash: str | None = Field(description="SHA-256 of all fields above")


class AuditList(Page[AuditEntry]):
    """A page of the audit, newest first."""


class AuditHead(Answer):
    """The newest sealed row. Record its hash elsewhere to verify the chain up to this row later."""

    seq: int = Field(description="number of sealed rows")
    hash: str | None = Field(description="hash of the newest sealed row; null if there is none")
