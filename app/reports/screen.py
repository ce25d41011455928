"""The report as an HTML page, in the frame and style of the other pages, with all values escaped."""

from __future__ import annotations

from pathlib import Path

from markupsafe import Markup

from app.presentation.environment import environment
from app.reports.content import Report


def display(formula: str) -> Markup:
    """Return a formula of the report, which is MathML, set as in a line of its own."""
    return Markup(formula.replace('display="inline"', 'display="block"', 1))


jinja = environment(Path(__file__).with_name("pages"))
jinja.filters["display"] = display


def page(report: Report) -> str:
    """Return a report as HTML."""
    base = f"/api/v1/designs/{report.design}/revisions/{report.revision}"
    return jinja.get_template("report.html").render(
        report=report, units=report.units, path=f"{base}/report", base=base
    )
