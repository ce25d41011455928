"""The signature block of a report: who calculated, checked and released the revision, with the digests."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from app.approvals.schemas import Approval, Block, BlockStep
from app.identity.principal import LOCAL
from app.identity.schemas.principals import Author
from app.presentation.units import System
from app.reports.cells import clean
from app.reports.content import Signature, Signatures
from app.schemas.approval_steps import ORDER, ApprovalState

ROLES = {"calculated": "Calculated", "checked": "Checked", "released": "Released", "withdrawn": "Withdrawn"}


def signatures_of(design: str, revision: int, units: System, steps: Sequence[Approval]) -> Signatures:
    """Return the signatures of a revision; a step not yet taken has no name."""
    taken = {one.step: one for one in steps}
    state: ApprovalState = steps[-1].step if steps else "unsigned"
    block = Block(
        format=1,
        design=design,
        revision=revision,
        units=units,
        state=state,
        steps=[BlockStep(step=s.step, name=s.name, at=s.at, digest=s.digest) for s in steps],
    )
    shown = [step for step in ORDER if step != "withdrawn" or step in taken]
    return Signatures(
        words=_words(state) + _common_creator(steps),
        is_released=state == "released",
        items=[_signature(ROLES[step], taken.get(step)) for step in shown],
        block=block.model_dump_json(),
    )


def author_of(author: Author | None, steps: Sequence[Approval]) -> str:
    """Return the name of a revision's author; empty for `local`, and for revisions made before version 0.2.

    After the hand-over the name at that time is used, so that renaming a principal changes no signed report.
    """
    if author is None or author.id == LOCAL.id:
        return ""
    signed = next((one.name for one in steps if one.principal == author.id), author.name)
    return clean(signed)


def of_variants(signatures: Signatures, *, has_appendix: bool) -> Signatures:
    """Return the signatures in the report of all variants, with or without its appendix."""
    more = {"has_variants": True, **({"has_appendix": True} if has_appendix else {})}
    block = Block.model_validate_json(signatures.block).model_copy(update=more)
    return replace(signatures, block=block.model_dump_json())


def _signature(role: str, step: Approval | None) -> Signature:
    if step is None:
        return Signature(role)
    content = step.content
    said = f"{_counted(content.unconfirmed)} not confirmed: {content.acknowledged}"
    return Signature(
        role,
        clean(step.name),
        moment(step.at),
        step.digest,
        clean(content.reason or ""),
        clean(said) if content.acknowledged else "",
    )


def _counted(criteria: Sequence[str]) -> str:
    return "1 criterion" if len(criteria) == 1 else f"{len(criteria)} criteria"


def moment(at: str) -> str:
    """Return a time in its printed form."""
    return f"{at[:10]} {at[11:19]} UTC"


def _common_creator(steps: Sequence[Approval]) -> str:
    """Return a clause about signers whose accounts one administrator created; empty if there are none."""
    names: dict[str, list[str]] = {}
    for step in steps:
        if step.content.account_by is not None:
            names.setdefault(step.content.account_by.name, []).append(clean(step.name))
    return "".join(
        f"; {clean(creator)} created the accounts of {' and '.join(dict.fromkeys(signers))}"
        for creator, signers in names.items()
        if len(set(signers)) > 1
    )


def _words(state: ApprovalState) -> str:
    if state == "released":
        return "Released"
    if state == "withdrawn":
        return "Withdrawn: not to be used any longer"
    return "Not released" if state == "unsigned" else f"Not released: {state} so far"
