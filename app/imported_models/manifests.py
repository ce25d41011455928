"""Read manifests of models, JSON files that users write, and define the patterns of their texts."""

from __future__ import annotations

from typing import TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from cad.errors import UnreadableModel

M = TypeVar("M", bound=BaseModel)

LONGEST = 2**18
"""Largest size of a manifest [bytes]."""
STRICT = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)
NAME = r"^[a-z][a-z0-9]*(_[a-z0-9]+)*$"
LINE = r"^[^\x00-\x1f\x7f]*$"
TITLE = r"^[^\x00-\x1f\x7f]*[^\x00-\x1f\x7f .][^\x00-\x1f\x7f]*$"


def read_manifest(kind: type[M], content: bytes, words: str) -> M:
    """Return a manifest from its JSON; messages use `words` as the name of the manifest.

    Raises
    ------
    UnreadableModel
        If there are faults; the error lists all of them.
    """
    if len(content) > LONGEST:
        raise UnreadableModel("too_large", f"a manifest may be at most {LONGEST // 1024} KiB in size")
    try:
        return kind.model_validate_json(content)
    except ValidationError as error:
        wrong = (
            f"{'.'.join(map(str, one['loc'])) or 'manifest'}: {one['msg']}" for one in error.errors()[:10]
        )
        raise UnreadableModel("manifest", f"{words} is not valid: {'; '.join(wrong)}") from None
