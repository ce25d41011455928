"""Parse XML into trees of plain nodes; document types and entities are refused.

The parser is the standard library's expat with handlers of this module. It drops namespaces, because their
prefixes are arbitrary, and in sheets the local name alone identifies an element.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.parsers import expat

from app.worksheets.imports.errors import SheetNotRead

DEEPEST = 200
MOST_NODES = 150_000
_SEPARATOR = "\n"  # cannot occur in a name


@dataclass(eq=False, slots=True)
class Node:
    """An element: its local name, its attributes, the elements in it, and its text with positions."""

    tag: str
    attributes: dict[str, str]
    namespace: str = ""
    parts: list[Node] = field(default_factory=list)
    pieces: list[str | Node] = field(default_factory=list)

    @property
    def text(self) -> str:
        """Return the text of this element itself, without that of its children."""
        return "".join(piece for piece in self.pieces if isinstance(piece, str))

    @property
    def whole_text(self) -> str:
        """Return the text of this element and of all elements within it."""
        return "".join(piece if isinstance(piece, str) else piece.whole_text for piece in self.pieces)

    def first(self, tag: str) -> Node | None:
        """Return the first child with this name."""
        return next((part for part in self.parts if part.tag == tag), None)

    def all(self, tag: str) -> Iterator[Node]:
        """Yield all elements with this name in document order; this element is included."""
        waiting = [self]
        while waiting:
            node = waiting.pop()
            if node.tag == tag:
                yield node
            waiting.extend(reversed(node.parts))

    def outermost(self, tag: str, *closed: str) -> Iterator[Node]:
        """Yield the outermost elements with this name inside this element, except those within `closed`."""
        waiting = list(reversed(self.parts))
        while waiting:
            node = waiting.pop()
            if node.tag == tag:
                yield node
            elif node.tag not in closed:
                waiting.extend(reversed(node.parts))


def read(content: bytes, name: str) -> Node:
    """Return the root of a document.

    Raises
    ------
    SheetNotRead
        If it is not XML, declares a document type or entities, nests too deep, or has too many elements.
    """
    return _Reader(name).read(content)


class _Reader:
    def __init__(self, name: str) -> None:
        self._name = name
        self._root: Node | None = None
        self._open: list[Node] = []
        self._count = 0
        parser = self._parser = expat.ParserCreate(namespace_separator=_SEPARATOR)
        parser.buffer_text = True
        parser.StartElementHandler, parser.EndElementHandler = self._start, self._end
        parser.CharacterDataHandler = self._characters
        parser.StartDoctypeDeclHandler = self._refuse_type
        parser.EntityDeclHandler = self._refuse_entity
        parser.ExternalEntityRefHandler = self._refuse_reference

    def read(self, content: bytes) -> Node:
        try:
            self._parser.Parse(content, True)
        except expat.ExpatError as error:
            place = f"line {error.lineno}, column {error.offset + 1}"
            what = f"{self._name} is not XML ({expat.ErrorString(error.code)} at {place})"
            raise SheetNotRead("xml", f"{what}: save the sheet again") from None
        except (LookupError, ValueError) as error:  # an unknown encoding
            raise SheetNotRead("xml", f"{self._name} is not XML ({error}): save the sheet again") from None
        assert self._root is not None, "a document without a root is not XML"
        return self._root

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self._count += 1
        if self._count > MOST_NODES:
            raise SheetNotRead(
                "too_large", f"{self._name} has more than {MOST_NODES} elements: split the sheet"
            )
        if len(self._open) >= DEEPEST:
            what = f"{self._name} nests deeper than {DEEPEST} elements"
            raise SheetNotRead("too_deep", f"{what}: split the longest formula into several")
        namespace, _, local = tag.rpartition(_SEPARATOR)
        plain = {key.rpartition(_SEPARATOR)[2]: value for key, value in attributes.items()}
        node = Node(local, plain, namespace)
        if self._open:
            self._open[-1].parts.append(node)
            self._open[-1].pieces.append(node)
        else:
            self._root = node
        self._open.append(node)

    def _end(self, tag: str) -> None:
        self._open.pop()

    def _characters(self, text: str) -> None:
        self._open[-1].pieces.append(text)

    def _refuse_type(self, *_: object) -> None:
        raise SheetNotRead("entities", f"{self._name} declares a document type, which no Mathcad sheet does")

    def _refuse_entity(self, *_: object) -> None:
        raise SheetNotRead("entities", f"{self._name} declares an entity, which no Mathcad sheet does")

    def _refuse_reference(self, *_: object) -> int:
        raise SheetNotRead(
            "entities", f"{self._name} refers to another document, which no Mathcad sheet does"
        )
