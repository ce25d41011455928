"""The drawing as PDF: its SVG on a page of its size, by Typst; vectors and letters, no pixels."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any

import typst

from cad.drafting.plan import SHEET

_NO_TIME = datetime(1970, 1, 1, tzinfo=UTC)
_PAGE = (
    f"#set page(width: {SHEET[0]:g}mm, height: {SHEET[1]:g}mm, margin: 0mm)\n"
    '#set document(title: "Technical drawing")\n'
    '#image("drawing.svg", width: 100%, height: 100%)\n'
)


def as_pdf(svg: bytes) -> bytes:
    """A drawing as PDF; equal drawings give equal bytes. What a client wrote in it is text there too."""
    files: Any = {"main": _PAGE.encode(), "drawing.svg": svg}  # missing in the types of typst
    pdf = typst.compile(files, format="pdf", timestamp=_NO_TIME)
    assert isinstance(pdf, bytes), "one document makes one file"
    return pdf
