"""`/stamp-keys`: the public keys that verify the stamps of STEP and GLB files."""

from __future__ import annotations

from fastapi import APIRouter

from app.api.dependencies import TheStampKeys
from app.http.strict_requests import StrictRoute
from app.signing.schemas import StampKey, StampKeyList

router = APIRouter(prefix="/api/v1/stamp-keys", tags=["files"], route_class=StrictRoute)


@router.get("")
def list_stamp_keys(keys: TheStampKeys) -> StampKeyList:
    """Return all public keys, also replaced ones: `crankwright verify FILE --key ANSWER` takes this answer.

    Get them on a way that you trust, and once: whoever can change the answer can make you trust another key.
    """
    return StampKeyList(items=[StampKey.model_validate(key) for key in (keys.public() if keys else [])])
