"""Sheets of Mathcad Prime (.mcdx): a ZIP of XML parts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from app.worksheets.imports.errors import SheetNotRead
from app.worksheets.imports.package import Budget, Package, is_package
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

WORKSHEET, RESULTS = "mathcad/worksheet.xml", "mathcad/result.xml"
RELATIONS, TAGS = "mathcad/_rels/worksheet.xml.rels", "mathcad/integration.xml"
CALCULATION = "mathcad/settings/calculation.xml"
TEXT = "Xaml/Document.xaml"  # the part with the words in the package of a text region

_KINDS: Mapping[str, Kind] = {
    "math": "math", "text": "text", "plot": "plot", "picture": "picture", "spec-table": "table",
    "solveblock": "solve block", "Area": "area", "pageBreak": "page break",
}  # fmt: skip
_FORMATS = {"resultFormat", "formattingOverride"}
_FAILED = {"engineErrors", "engineError"}


def read_prime(content: bytes) -> OriginalSheet:
    """Return the sheet in a .mcdx file.

    Raises
    ------
    SheetNotRead
        If it is not such a file, is damaged, or is too large.
    """
    budget = Budget()
    package = Package(content, budget)
    sheet = _part(package, WORKSHEET)
    if sheet is None or sheet.first("regions") is None:
        what = "it has no part mathcad/worksheet.xml with regions"
        raise SheetNotRead(
            "no_sheet", f"{what}: send a .mcdx of Mathcad Prime or a .xmcd or .xmcdz of Mathcad 11 to 15"
        )
    reader = _Reader(package, budget, _results(package), *_tags(package), _targets(package))
    regions = tuple(reader.regions(sheet))
    counted = count_regions(package.read(WORKSHEET) or b"")
    return OriginalSheet("Mathcad Prime", regions, counted, _origin(package))


def _part(package: Package, name: str) -> Node | None:
    content = package.read(name)
    return None if content is None else read(content, name)


def _results(package: Package) -> dict[str, Node]:
    part = _part(package, RESULTS)
    nodes = part.all("resultData") if part else ()
    return {node.attributes.get("result-id", ""): node for node in nodes}


def _tags(package: Package) -> tuple[dict[str, Tag], dict[str, str]]:
    part = _part(package, TAGS)
    tags, aliases = dict[str, Tag](), dict[str, str]()
    for region in part.all("region") if part else ():
        number, kind = region.attributes.get("region-id", ""), region.attributes.get("ioTagType", "")
        tags[number] = "input" if kind == "Input" else "output" if kind == "Output" else ""
        aliases[number] = next((alias.text for alias in region.all("alias")), "")
    return tags, aliases


def _targets(package: Package) -> dict[str, str]:
    part = _part(package, RELATIONS)
    nodes = part.all("Relationship") if part else ()
    return {node.attributes.get("Id", ""): node.attributes.get("Target", "").lstrip("/") for node in nodes}


def _origin(package: Package) -> int:
    part = _part(package, CALCULATION)
    settings = next(part.all("builtInVariables"), None) if part else None
    text = settings.attributes.get("array-origin", "0") if settings else "0"
    return int(text) if text.lstrip("-").isdigit() and len(text) < 6 else 0


@dataclass
class _Reader:
    package: Package
    budget: Budget
    results: Mapping[str, Node]
    tags: Mapping[str, Tag]
    aliases: Mapping[str, str]
    targets: Mapping[str, str]
    count: int = field(default=0)

    def regions(self, node: Node, block: str = "") -> Iterator[Original]:
        """Yield the regions within an element, including those nested in areas."""
        for region in node.outermost("region"):
            yield from self._region(region, block)

    def _region(self, region: Node, block: str) -> Iterator[Original]:
        self.count += 1
        if self.count > MOST_REGIONS:
            raise SheetNotRead("too_large", f"it has more than {MOST_REGIONS} regions: split the sheet")
        body = next(iter(region.parts), region)
        kind = _KINDS.get(body.tag, "other")
        maths = list(body.outermost("math", "region")) if kind == "table" else []
        for math in maths:
            yield self._original(region, "math", math, block)
        if not maths:
            yield self._original(region, kind, body, block)
        number = region.attributes.get("region-id", "")
        yield from self.regions(body, number if kind == "solve block" else block)

    def _original(self, region: Node, kind: Kind, body: Node, block: str) -> Original:
        number = region.attributes.get("region-id", "")
        cached = self.results.get(body.attributes.get("resultRef", "")) if kind == "math" else None
        math = next((part for part in body.parts if part.tag not in _FORMATS), None)
        return Original(
            number=number_of(number),
            kind=kind,
            top=coordinate(region.attributes.get("top")),
            left=coordinate(region.attributes.get("left")),
            math=math if kind == "math" else None,
            cached=cached.first("result") if cached else None,
            text=self._text(body) if kind == "text" else "",
            tag=self.tags.get(number, ""),
            alias=self.aliases.get(number, ""),
            role=region.attributes.get("solve-block-category", ""),
            block=block,
            failed=cached is not None and any(part.tag in _FAILED for part in cached.parts),
        )

    def _text(self, body: Node) -> str:
        """Return the words of a text region, which are stored in a separate package."""
        content = self.package.read(self.targets.get(body.attributes.get("item-idref", ""), ""))
        if content is None or not is_package(content):
            return body.whole_text.strip()
        document = Package(content, self.budget).read(TEXT)
        if document is None:
            return ""
        paragraphs = read(document, "a text region").all("Paragraph")
        return "\n".join(" ".join(paragraph.whole_text.split()) for paragraph in paragraphs).strip()
