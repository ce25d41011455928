"""Convert principals, keys and usage to the schemas of the interface."""

from __future__ import annotations

from app.identity import usage
from app.identity.limits import Limits
from app.identity.principal import ROLES, Principal
from app.identity.schemas import principals as schemas
from app.identity.usage import PrincipalUsage
from app.storage.tables import ApiKeyRow, PrincipalRow


def principal(row: PrincipalRow) -> schemas.Principal:
    """Return a principal."""
    return schemas.Principal.model_validate(
        {name: getattr(row, name) for name in schemas.Principal.model_fields}
    )


def me(who: Principal, amounts: schemas.Usage) -> schemas.Me:
    """Return the principal that sends the request."""
    roles = [role for role in ROLES if role in who.roles]
    return schemas.Me(id=who.id, name=who.name, kind=who.kind, roles=roles, usage=amounts)


def key(row: ApiKeyRow) -> schemas.Key:
    """Return a key, without its secret."""
    return schemas.Key.model_validate({name: getattr(row, name) for name in schemas.Key.model_fields})


def used(amounts: PrincipalUsage, limits: Limits | None) -> schemas.Usage:
    """Return the usage together with the limits."""
    return schemas.Usage(
        requests=amounts.requests,
        jobs=amounts.jobs,
        calculation_seconds=amounts.seconds,
        storage_mb=amounts.bytes / usage.MIB,
        queued_jobs=amounts.queued,
        limits=schemas.Limits(**vars(limits)) if limits else None,
    )
