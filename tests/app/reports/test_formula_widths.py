"""The bound of a formula's width in a report is at least the width that Typst measures."""

import json

import pytest
import typst

from app.calculations.worksheet import formulas
from app.catalogue.discovery import find_templates
from app.reports import widths
from app.reports.typesetting import DOCUMENT
from app.reports.widths import fits
from templates.core.errors import TemplateError
from templates.core.language.evaluate import evaluate

EM = 9.5  # [pt]
SPACE = "http://www.w3.org/1998/Math/MathML"
MOST_QUICK = 3  # templates in the quick suite


def measured(mathml):
    """The width of each formula as the report sets it [em]."""
    text = DOCUMENT.read_text(encoding="utf-8")
    begin, end = text.index("// MathML → mathematics"), text.index("// What is wider")
    rules = (line for line in text.splitlines() if line.startswith(("#set text(", "#show math.")))
    ask = '#context [#metadata(json("all.json").map(one => measure(inline(one)).width.pt())) <widths>]'
    files = {
        "main": "\n".join(['#let ink = rgb("#1b2733")', *rules, text[begin:end], ask]).encode(),
        "all.json": json.dumps(mathml).encode(),
    }
    (found,) = json.loads(typst.query(files, "<widths>"))
    return [width / EM for width in found["value"]]


def bound(mathml):
    return widths._bound(widths._alike(mathml))


def too_narrow(mathml):
    """Of these formulas, those wider than their bound."""
    pairs = zip(mathml, measured(mathml), strict=True)
    return [(one, width, bound(one)) for one, width in pairs if width > bound(one)]


def math(inside):
    return f'<math xmlns="{SPACE}" display="inline"><mrow>{inside}</mrow></math>'


def escaped(sign):
    return f"&#x{ord(sign):05X};"


def test_no_sign_is_wider_than_its_bound():
    styles = ("<mi>{}</mi>", '<mi mathvariant="normal">{}</mi>', "<mtext>{}</mtext>", "<mn>{}</mn>")
    signs = [math(style.format(escaped(sign))) for sign in widths._SIGNS for style in styles]
    between = [math(f"<mi>a</mi><mo>{escaped(sign)}</mo><mi>b</mi>") for sign in "=<>≤≥≠+−·×/"]
    assert too_narrow(signs + between) == []


def test_structures_are_no_wider_than_their_bound():
    tall = "<mfrac><mfrac><mi>W</mi><mi>m</mi></mfrac><mfrac><mi>W</mi><mn>1</mn></mfrac></mfrac>"
    fenced = '<mo fence="true" form="prefix">(</mo>{}<mo fence="true" form="postfix">)</mo>'
    built = [
        fenced.format(tall), f"<msqrt>{tall}</msqrt>", f"<msup><mi>f</mi>{tall}</msup>",
        "<msubsup><mi>W</mi><mi>m</mi><mi>W</mi></msubsup>",
        "<msup><mi>a</mi><msup><mi>W</mi><mi>W</mi></msup></msup>",
        "<mi>ln</mi><mi>x</mi><mi>exp</mi><mi>x</mi>",
        '<mo fence="true" form="prefix">{</mo><mtable><mtr><mtd><mn>1</mn></mtd><mtd><mi>W</mi></mtd></mtr>'
        "<mtr><mtd><mi>W</mi></mtd><mtd><mn>1</mn></mtd></mtr></mtable>",
    ]  # fmt: skip
    assert too_narrow([math(one) for one in built]) == []


def test_what_may_come_from_another_font_has_no_bound():
    assert not fits([math("<mtext>漢</mtext>")], 1000.0)
    assert not fits([math("<mtext>﷽</mtext>")], 1000.0)
    assert not fits([math("<mphantom><mi>a</mi></mphantom>")], 1000.0)
    assert not fits(["<math"], 1000.0)
    assert fits(["", math("<mi>a</mi>")], 2.0)


def cases():
    """Each template's formulas at its example, in both systems of units."""
    for number, cls in enumerate(find_templates(())):
        slow = [pytest.mark.slow] if number >= MOST_QUICK else []
        yield pytest.param(cls, id=f"{cls.id} {cls.version}", marks=slow)


@pytest.mark.parametrize("cls", list(cases()))
def test_no_formula_of_a_template_is_wider_than_its_bound(cls):
    try:
        evaluation = evaluate(cls, cls.example)
    except TemplateError:
        pytest.skip("its example needs a solid")
    written = (formulas(evaluation.template, system, evaluation.outputs) for system in ("si", "us"))
    rows = [row for each in written for row in each]
    parts = [part for row in rows for part in row["mathml"].values() if part]
    assert too_narrow(parts) == []
