"""Errors of signatures.

ApprovalError
    NotReady            the revision is not calculated, or a file of it is missing
    OutOfOrder          another step comes first, or the step is taken
    Unacknowledged      what is said of unconfirmed criteria is missing, or needless
    SamePrincipal       the principal has taken another step, or is not the author
    OtherDigest         the content to sign has changed since the signer read it
"""

from __future__ import annotations

from app.identity.principal import LOCAL


class ApprovalError(Exception):
    """Anything that approval refuses."""


class NotReady(ApprovalError):
    """The revision cannot be signed as it is."""


class Unacknowledged(ApprovalError):
    """What the signer says about criteria that are not confirmed is missing, or there are none."""


class OutOfOrder(ApprovalError):
    """Another step comes first, or the step is taken."""


class SamePrincipal(ApprovalError):
    """The principal may not take this step, because of another that it has taken."""

    def __init__(self, detail: str, principal: str) -> None:
        if principal == LOCAL.id:
            detail += "; this service asks nobody for a key, so everyone is one: `crankwright keys add`"
        super().__init__(detail)


class OtherDigest(ApprovalError):
    """What there is to sign is not what the signer saw."""

    def __init__(self, right: str) -> None:
        self.headers = {"ETag": f'"{right}"'}
        super().__init__(
            "what there is to sign is not what If-Match names: read the revision and its approvals again; "
            f'then sign with If-Match: "{right}"'
        )
