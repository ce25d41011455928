"""Sheets of Mathcad 11 to 15 (.xmcd, .xmcdz): one XML document, converted to the form of Mathcad Prime."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import islice

from app.worksheets.imports.errors import SheetNotRead
from app.worksheets.imports.package import Budget, unpacked
from app.worksheets.imports.regions import (
    MOST_REGIONS,
    Kind,
    Original,
    OriginalSheet,
    Tag,
    coordinate,
    count_regions,
    number_of,
)
from app.worksheets.imports.trees import Node, read

_KINDS: Mapping[str, Kind] = {
    "math": "math", "text": "text", "plot": "plot", "picture": "picture", "area": "area",
    "pageBreak": "page break",
}  # fmt: skip
_GZIP = b"\x1f\x8b"
_RENAMED = {"ifThen": "if", "otherwise": "else", "sqrt": "nthRoot"}
_SKIPPED = {"originRef", "parentRef", "comment", "originComment", "contentHash", "resultFormat"}


def read_legacy(content: bytes) -> OriginalSheet:
    """Return the sheet in a .xmcd file, or in a .xmcdz file, which is compressed by gzip.

    Regions may be in the sheet, in its areas, collapsed or not, and in its texts.

    Raises
    ------
    SheetNotRead
        If it is not such a file, or is too large.
    """
    if content.startswith(_GZIP):
        content = unpacked(content, Budget())
    root = read(content, "the file")
    if root.tag != "worksheet" or root.first("regions") is None:
        what = f"its outermost element is {root.tag[:40]!a}"
        raise SheetNotRead(
            "no_sheet", f"{what}: send a .mcdx of Mathcad Prime or a .xmcd or .xmcdz of Mathcad 11 to 15"
        )
    regions = tuple(_original(region) for region in islice(root.all("region"), MOST_REGIONS + 1))
    if len(regions) > MOST_REGIONS:
        raise SheetNotRead("too_large", f"it has more than {MOST_REGIONS} regions: split the sheet")
    counted = count_regions(content)
    return OriginalSheet("Mathcad", regions, counted, _origin(root), results_carry_units=True)


def _origin(root: Node) -> int:
    settings = next(root.all("builtInVariables"), None)
    text = settings.attributes.get("array-origin", "0") if settings else "0"
    return int(text) if text.lstrip("-").isdigit() and len(text) < 6 else 0


def _original(region: Node) -> Original:
    body = next((part for part in region.parts if part.tag in _KINDS), None) or next(
        iter(region.parts), region
    )
    kind = _KINDS.get(body.tag, "other")
    math = _math(body) if kind == "math" else None
    cached = next(math.all("result"), None) if math else None
    paragraphs = (" ".join(part.whole_text.split()) for part in body.all("p")) if kind == "text" else ()
    named = region.attributes.get("tag", "").lower()
    tag: Tag = "input" if named == "input" else "output" if named == "output" else ""
    return Original(
        number=number_of(region.attributes.get("region-id")),
        kind=kind,
        top=coordinate(region.attributes.get("align-y") or region.attributes.get("top")),
        left=coordinate(region.attributes.get("left")),
        math=math,
        cached=cached,
        text="\n".join(paragraphs).strip(),
        tag=tag,
    )


def _math(body: Node) -> Node | None:
    math = next((part for part in body.parts if part.tag not in _SKIPPED), None)
    while math is not None and math.tag == "provenance":  # records the origin of a copied formula
        math = next((part for part in math.parts if part.tag not in _SKIPPED), None)
    if math is not None:
        _renew(math)
    return math


def _renew(node: Node) -> None:
    """Convert trees in place to the form of Mathcad Prime: element names, conditions and subscripts."""
    waiting = [node]
    while waiting:
        node = waiting.pop()
        node.tag = _RENAMED.get(node.tag, node.tag)
        unwrapped = [_unwrapped(part) for part in node.parts]
        if unwrapped != node.parts:
            node.parts, node.pieces = unwrapped, list(unwrapped)
        if node.tag == "if" and len(node.parts) == 2:
            node.parts = [Node("test", {}, "", [node.parts[0]]), Node("then", {}, "", [node.parts[1]])]
        if node.tag == "id" and (below := node.attributes.pop("subscript", "")):
            node.pieces.append(Node("Subscript", {}, pieces=[below]))
        waiting.extend(node.parts)


def _unwrapped(node: Node) -> Node:
    while node.tag == "provenance":
        kept = [part for part in node.parts if part.tag not in _SKIPPED]
        if not kept:
            break
        node = kept[-1]
    return node
