"""Responses about the keys with which the service signs."""

from __future__ import annotations

from pydantic import ConfigDict, Field

from app.schemas.answers import Answer


class StampKey(Answer):
    """A public key that verifies stamps."""

    model_config = ConfigDict(from_attributes=True)

    id: str = Field(description="name of the key in stamps: 16 hexadecimal digits")
    public: str = Field(description="`ed25519:` and 64 hexadecimal digits", examples=["ed25519:" + 64 * "0"])
    since: str | None = Field(description="when the service began to sign with it (UTC); null if unknown")
    until: str | None = Field(description="when it was replaced; null while it is in use")


class StampKeyList(Answer):
    """The public keys of the service, the one in use first; empty if the service does not sign."""

    items: list[StampKey]
