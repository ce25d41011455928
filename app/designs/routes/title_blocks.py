"""Title-block fields that a client sets for one download; entries of an approval have priority."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated
from unicodedata import normalize

from fastapi import Depends, Query

from app.schemas.approval_steps import ORDER
from cad.file_kinds import DRAWINGS, VALIDATED
from cad.stamp import Stamp
from templates.core.errors import Fault, InvalidInputs

LONGEST = 80  # characters; a field shows as many as fit
STEP = ("step", VALIDATED)
_ON_PARTS = {"drawing_number", "drawing_revision"}
"""The fields that a STEP file has: the number of its product, and its revision."""

Typed = Annotated[str, Query(max_length=LONGEST)]

_SIGNED = {"author": "created_by", "checker": "checked_by", "approver": "approved_by"}
"""Steps of an approval that set a name, and the parameters with which a client may type it."""
_ONLY_SIGNED = {"checker", "approver"}
"""Names that a client may not type, because a drawing must not claim an approval that did not happen."""


@dataclass(frozen=True)
class TitleBlock:
    """The typed texts by parameter; an empty text leaves its field unchanged."""

    texts: dict[str, str]

    def on(self, stamp: Stamp, kind: str) -> Stamp:
        """Return the stamp with these texts added.

        Raises
        ------
        InvalidInputs
            If the kind of file has no title block, or a text contradicts the approval.
        """
        typed = {name: plain for name, text in self.texts.items() if (plain := _shown(text))}
        offered = _ON_PARTS if kind in STEP else {*self.texts} if kind in DRAWINGS else set[str]()
        if wrong := typed.keys() - offered:
            drawings = ", ".join(DRAWINGS)
            detail = f"{drawings} have a title block; a STEP file has `drawing_number` and `drawing_revision`"
            raise InvalidInputs(Fault(n, "not_offered", f"{detail}; omit it for {kind}") for n in wrong)
        if faults := [*_contradictions(typed, stamp)]:
            raise InvalidInputs(faults)
        return replace(
            stamp,
            owner=typed.get("legal_owner", stamp.owner),
            title=typed.get("drawing_title", ""),
            number=typed.get("drawing_number", ""),
            mark=typed.get("drawing_revision", ""),
            author=typed.get("created_by", stamp.author),
            checker=typed.get("checked_by", stamp.checker),
            approver=typed.get("approved_by", stamp.approver),
            status=typed.get("document_status", stamp.status),
        )


def _contradictions(typed: dict[str, str], stamp: Stamp) -> list[Fault]:
    """Return a fault for each typed name or state that contradicts the approval."""
    faults = []
    for field, name in _SIGNED.items():
        signed = getattr(stamp, field)
        if typed.get(name, signed) == signed:
            continue
        if signed:
            detail = f"the record of this revision sets {signed!r} here; omit the typed text"
            faults.append(Fault(name, "signed_otherwise", detail))
        elif field in _ONLY_SIGNED:
            detail = "nobody has signed here, and only a step of the approval sets this name; omit it"
            faults.append(Fault(name, "signed_otherwise", detail))
    status = typed.get("document_status", stamp.status)
    if status != stamp.status and (stamp.status in ORDER or _letters(status) in ORDER):
        detail = f"the approval sets {stamp.status!r} here, which only a step of the approval can change"
        faults.append(Fault("document_status", "signed_otherwise", detail))
    return faults


def _shown(text: str) -> str:
    """Return a text as a drawing shows it: trimmed, with unprintable characters replaced by spaces."""
    return "".join(sign if sign.isprintable() else " " for sign in text).strip()


def _letters(text: str) -> str:
    """Return a text reduced to lower-case Latin letters.

    This finds texts such as `Released.` and `ｒeleased`, which look like `released` to a reader.
    """
    return "".join(sign for sign in normalize("NFKD", text).lower() if "a" <= sign <= "z")


def title_block(
    legal_owner: Typed = "",
    drawing_title: Typed = "",
    drawing_number: Typed = "",
    drawing_revision: Typed = "",
    created_by: Typed = "",
    checked_by: Typed = "",
    approved_by: Typed = "",
    document_status: Typed = "",
) -> TitleBlock:
    """Return the typed texts of a request: fields of ISO 7200, or for a STEP file number and revision."""
    return TitleBlock(
        {
            "legal_owner": legal_owner,
            "drawing_title": drawing_title,
            "drawing_number": drawing_number,
            "drawing_revision": drawing_revision,
            "created_by": created_by,
            "checked_by": checked_by,
            "approved_by": approved_by,
            "document_status": document_status,
        }
    )


TheTitleBlock = Annotated[TitleBlock, Depends(title_block)]
