"""Check FreeCAD files: accept only packages of limited size with features that run no Python.

A `.FCStd` file is a ZIP archive of `Document.xml` and the shapes to which it refers. A Python feature is an
object whose type ends in `Python`, with a proxy that FreeCAD imports by the name of its module: such a file
is refused, as is one that reads other files. An accepted file is packed again with only the parts that the
document names. So macros are dropped, and FreeCAD reads only packages that this program wrote.

This check runs in a separate process with limited memory and time.
"""

from __future__ import annotations

import io
import re
import struct
import zipfile
import zlib
from collections.abc import Iterator
from xml.parsers import expat

from cad.errors import UnreadableModel

MOST_PARTS = 2000
MOST_BYTES = 64 * 2**20
"""Largest size of all parts, unpacked; it is counted while reading, because the package may state another."""
LONGEST_DOCUMENT = 16 * 2**20
DEEPEST = 100
DOCUMENT = "Document.xml"
AGAIN = "save the file in FreeCAD again, and send that file"

_DRAWING = re.compile(r"(?:Part|PartDesign|Sketcher|Spreadsheet)::[A-Za-z0-9]+")
_GROUPING = {
    f"App::{name}"
    for name in (
        "DocumentObjectGroup", "Part", "Origin", "Line", "Plane", "Point", "Link", "LinkGroup", "LinkElement",
        "Annotation", "AnnotationLabel", "TextDocument", "MaterialObject", "VarSet",
    )
}  # fmt: skip
_READING_FILES = {"Part::ImportStep", "Part::ImportIges", "Part::ImportBrep", "Part::CurveNet"}
_REFUSED_PROPERTIES = re.compile(r"App::Property(?:File|Path)\w*")
_LINKS = {"XLink", "XLinkSub", "XLinkSubList"}
_DAMAGES = (
    zipfile.BadZipFile, zlib.error, EOFError, OSError, RuntimeError, struct.error, ValueError, OverflowError,
    NotImplementedError,
)  # fmt: skip
"""Errors that `zipfile` raises for invalid or damaged packages."""
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_DIRECTORY, _LARGE_DIRECTORY = b"PK\x05\x06", b"PK\x06\x07"  # end records of ZIP and of ZIP64


def admitted(content: bytes) -> bytes:
    """Return the file in a form that is safe for FreeCAD to open.

    Raises
    ------
    UnreadableModel
        If the file is not from FreeCAD, is too large, runs Python, or reads other files.
    """
    parts = dict(_unpacked(content))
    if DOCUMENT not in parts:
        raise UnreadableModel("not_freecad", f"it has no {DOCUMENT}: it is not a FreeCAD file (.FCStd)")
    named = _Document().read(parts[DOCUMENT])
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as package:
        for name, part in parts.items():
            if (
                name == DOCUMENT or name in named
            ):  # compressed at a low level, so that a zip bomb of zeros is not stored at full size
                package.writestr(zipfile.ZipInfo(name), part, zipfile.ZIP_DEFLATED, 1)
    return out.getvalue()


def _unpacked(content: bytes) -> Iterator[tuple[str, bytes]]:
    left = MOST_BYTES
    _check_directory(content)
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as package:
            for part in package.infolist():
                if not part.filename or part.is_dir() or part.filename.endswith((".py", ".FCMacro")):
                    continue
                if part.compress_type not in _METHODS:
                    raise UnreadableModel(
                        "package", f"it is compressed in a way that FreeCAD does not use: {AGAIN}"
                    )
                with package.open(part) as opened:
                    read = opened.read(left + 1)
                left -= len(read)
                if left < 0:
                    what = f"its parts are larger than {MOST_BYTES // 2**20} MiB when unpacked"
                    raise UnreadableModel("too_large", f"{what}: remove shapes that the model does not need")
                yield part.filename, read
    except _DAMAGES as error:
        raise UnreadableModel("package", f"it is not a complete ZIP package ({error}): {AGAIN}") from None


def _check_directory(content: bytes) -> None:
    """Refuse a directory with too many entries before `zipfile` creates an object for each."""
    place = content.rfind(_DIRECTORY, max(0, len(content) - 2**16 - 22))
    if place < 0 or len(content) < place + 22:
        raise UnreadableModel(
            "package", f"it is not a complete ZIP package (its directory is missing): {AGAIN}"
        )
    if content.startswith(_LARGE_DIRECTORY, max(0, place - 20)):
        raise UnreadableModel("package", f"it is a ZIP64 package, which this service does not read: {AGAIN}")
    entries, size = struct.unpack("<HI", content[place + 10 : place + 16])
    if entries > MOST_PARTS or size > MOST_PARTS * 400:
        raise UnreadableModel("too_large", f"it has {entries} parts; a model may have at most {MOST_PARTS}")


class _Document:
    """Reads a document element by element: checks each, and records the parts of the package that it names.

    Entities are never expanded: a document that declares any is refused.
    """

    def __init__(self) -> None:
        self.named = set[str]()
        self._depth = 0

    def read(self, text: bytes) -> set[str]:
        """Return the parts that a document names.

        Raises
        ------
        UnreadableModel
            If the document is damaged, or one of its elements is refused.
        """
        if len(text) > LONGEST_DOCUMENT:
            what = f"its {DOCUMENT} is larger than {LONGEST_DOCUMENT // 2**20} MiB"
            raise UnreadableModel("too_large", f"{what}: split the model")
        if b"\0" in text[:4] or text[:2] in (b"\xff\xfe", b"\xfe\xff"):
            raise self._of_another_encoding()
        parser = expat.ParserCreate()
        parser.XmlDeclHandler = self._check_encoding
        parser.StartDoctypeDeclHandler = self._refuse_declarations
        parser.StartElementHandler = self._begin
        parser.EndElementHandler = self._end
        try:
            parser.Parse(text, True)
        except expat.ExpatError as error:
            raise UnreadableModel("package", f"its {DOCUMENT} is damaged ({error}): {AGAIN}") from None
        return self.named

    def _check_encoding(self, version: str, encoding: str | None, standalone: int) -> None:
        """Refuse encodings in which FreeCAD might read different elements from those that this check sees.

        FreeCAD itself writes UTF-8.
        """
        if encoding is not None and encoding.lower() != "utf-8":
            raise self._of_another_encoding()

    def _of_another_encoding(self) -> UnreadableModel:
        return UnreadableModel("package", f"its {DOCUMENT} is not in UTF-8, as FreeCAD writes it: {AGAIN}")

    def _refuse_declarations(self, *_: object) -> None:
        raise UnreadableModel("package", f"its {DOCUMENT} declares entities: {AGAIN}")

    def _begin(self, tag: str, attributes: dict[str, str]) -> None:
        if self._depth == 0 and tag != "Document":
            raise UnreadableModel("not_freecad", f"its {DOCUMENT} was not written by FreeCAD")
        self._depth += 1
        if self._depth > DEEPEST:
            raise UnreadableModel(
                "package", f"its {DOCUMENT} nests elements more than {DEEPEST} deep: {AGAIN}"
            )
        _check_element(tag, attributes)
        self.named.update(attributes.get(key, "") for key in ("file", "File"))

    def _end(self, tag: str) -> None:
        self._depth -= 1


def _check_element(tag: str, attributes: dict[str, str]) -> None:
    kind = attributes.get("type", "")
    name = (attributes.get("name") or attributes.get("Name") or tag)[:60]
    if tag == "Python" or "Python" in kind:
        what = f"{name!r} ({kind or tag}) is a Python feature or a macro, which is never run here"
        raise UnreadableModel("python_feature", f"{what}: replace it with features of Part or PartDesign")
    if _REFUSED_PROPERTIES.fullmatch(kind) or kind in _READING_FILES:
        raise UnreadableModel("reads_files", f"{name!r} ({kind}) reads another file: embed its shape")
    if tag in _LINKS and attributes.get("file"):
        raise UnreadableModel("reads_files", "it links to another document: copy what it needs into this one")
    if tag == "Object" and kind and not (_DRAWING.fullmatch(kind) or kind in _GROUPING):
        what = f"{name!r} ({kind}) is of a workbench that is not opened here"
        raise UnreadableModel("not_offered", f"{what}: use Part, PartDesign, Sketcher and Spreadsheet")
