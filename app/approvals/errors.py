"""Errors of signatures.

ApprovalError
    NotReady            the revision is not calculated, or a file of it is missing
    OutOfOrder          another step must be taken first, or this step was already taken
    Unacknowledged      the statement on unconfirmed criteria is missing, or not needed
    SamePrincipal       the principal has taken another step, or is not the author
    OtherDigest         the content to sign has changed since the signer read it
"""

from __future__ import annotations

from app.identity.principal import LOCAL


class ApprovalError(Exception):
    """Base class of all errors that refuse an approval."""


class NotReady(ApprovalError):
    """The revision cannot be signed in its present state."""


class Unacknowledged(ApprovalError):
    """The signer's statement on unconfirmed criteria is missing, or no criterion is unconfirmed."""


class OutOfOrder(ApprovalError):
    """Another step must be taken first, or this step was already taken."""


class SamePrincipal(ApprovalError):
    """The principal may not take this step because it took another step, or is or is not the author."""

    def __init__(self, detail: str, principal: str) -> None:
        if principal == LOCAL.id:
            detail += "; this service asks nobody for a key, so everyone is one: `crankwright keys add`"
        super().__init__(detail)


class OtherDigest(ApprovalError):
    """The content to sign has changed since the signer read it."""

    def __init__(self, right: str) -> None:
        self.headers = {"ETag": f'"{right}"'}
        super().__init__(
            "the content to sign is not that of If-Match: read the revision and its approvals again; "
            f'then sign with If-Match: "{right}"'
        )
