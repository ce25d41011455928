"""Convert a drawing to PDF: Typst places its SVG on a page of the same size, as vectors and text."""

from __future__ import annotations

import re
from datetime import UTC, datetime
from importlib.metadata import version
from typing import Any

import typst

from cad.drafting.formats import FORMATS

TYPESETTER = f"typst {version('typst')}"
"""What makes the bytes of a PDF, beside its drawing."""

_NO_TIME = datetime(1970, 1, 1, tzinfo=UTC)
_SIZE = re.compile(rb'<svg [^>]*?width="(\d+)mm" height="(\d+)mm"')  # of the sheet, as `svg` writes it
_PAGE = (
    "#set page(width: {:g}mm, height: {:g}mm, margin: 0mm)\n"
    '#set document(title: "Technical drawing")\n'
    '#image("drawing.svg", width: 100%, height: 100%)\n'
)


def as_pdf(svg: bytes) -> bytes:
    """Return a drawing as PDF.

    Equal drawings give equal bytes. Text that a client entered stays text in the PDF.
    """
    files: Any = {
        "main": _PAGE.format(*_size(svg)).encode(),
        "drawing.svg": svg,
    }  # missing in the types of typst
    pdf = typst.compile(files, format="pdf", timestamp=_NO_TIME)
    assert isinstance(pdf, bytes), "one document makes one file"
    return pdf


def _size(svg: bytes) -> tuple[float, float]:
    """Return the width and height of a drawing's sheet [mm], read ahead of any text of a client."""
    found = _SIZE.search(svg[:500])
    return (float(found[1]), float(found[2])) if found else (FORMATS[0].width, FORMATS[0].height)
