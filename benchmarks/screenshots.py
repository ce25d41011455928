"""Take the screenshots docs/pictures/{home,template,…}-{wide,narrow}.png from a running service.

    python -m benchmarks.screenshots

The script needs Debian's package chromium. The screenshots are not retouched: they show each page as a
visitor first sees it, for some pages after a click on a picture.
"""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page

from benchmarks.browser import chromium, examples
from templates.examples.index import examples as worksheets

PICTURES = Path(__file__).parents[1] / "docs" / "pictures"
SCREENS = {"wide": (1440, 900), "narrow": (390, 844)}
EXAMPLE = worksheets()[0]  # the paper's worksheet
COLOURS = 256  # colours of a picture: enough for the eye, and small files
MOST_BYTES = 300_000
LONGEST = 120_000  # ms that a part may take to be built and analysed


def main() -> None:
    """Take a picture of every page on every screen."""
    with examples(("paper", "shell")) as (url, (paper, shell), client), chromium() as browser:
        design = client.design(paper.rpartition("/")[2])
        client.change(design, {"parameters": {"scale": "1"}, "note": "the size of the paper"})
        sheet = client.create_worksheet("my_bearing", EXAMPLE.text, author="A. Weber")
        pages = {
            "home": "/",
            "template": "/templates/oil_film/1",
            "worksheet": f"/worksheets/{sheet.id}",
            "design": paper,
            "shell": shell,
            "throw": "/models/crank_throw/1",
            "report": f"{paper}/report",
        }
        for screen, (width, height) in SCREENS.items():
            page = browser.new_page(viewport={"width": width, "height": height})
            for name, path in pages.items():
                picture = PICTURES / f"{name}-{screen}.png"
                _write(picture, _seen(page, url + path, PAINTED.get(name)))
                print(f"{picture.name:22} {picture.stat().st_size / 1000:6.0f} kB")


def _with_pressure(page: Page) -> None:
    """Open a shell with the pressure of its film."""
    page.get_by_label("show the film pressure").check()
    page.locator(".solid .colours").wait_for()
    page.evaluate("scrollTo(0, 0)")


def _with_stress(page: Page) -> None:
    """Open a throw under a torque."""
    panel = page.locator("[data-elements]")
    panel.wait_for(timeout=LONGEST)
    panel.get_by_role("button", name="Analyse").click()
    panel.locator(".js-plotly-plot").wait_for(timeout=LONGEST)
    panel.locator("[data-deformed]").evaluate("(place) => place.scrollIntoView({ block: 'end' })")
    page.wait_for_timeout(1500)


def _with_a_fault(page: Page) -> None:
    """Open a worksheet with a wrong unit in line 22, which is explained below it."""
    page.locator("#text").evaluate("""(area) => {
      const place = area.value.indexOf("= D - c") + 6;
      area.focus({ preventScroll: true });
      area.setSelectionRange(place, place + 1);
      document.execCommand("insertText", false, "F");
    }""")
    page.locator(".note").wait_for()
    page.locator(".line.faulty").evaluate("(line) => scrollTo(0, line.getBoundingClientRect().top - 420)")
    page.wait_for_timeout(500)


PAINTED: dict[str, Callable[[Page], None]] = {
    "worksheet": _with_a_fault,
    "shell": _with_pressure,
    "throw": _with_stress,
}
"""Actions on a page before its picture is taken."""


def _seen(page: Page, address: str, painted: Callable[[Page], None] | None) -> bytes:
    """Return the screenshot of a page once everything on it is drawn."""
    answer = page.goto(address, wait_until="networkidle")
    assert answer is not None
    assert answer.ok, f"{address} answers {answer.status}"
    page.wait_for_timeout(1500)  # charts appear only after the network is idle
    if painted:
        painted(page)
    return page.screenshot()


def _write(path: Path, png: bytes) -> None:
    """Write a picture with few colours."""
    picture = (
        Image.open(io.BytesIO(png))
        .convert("RGB")
        .quantize(COLOURS, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    )
    picture.save(path, optimize=True)
    assert path.stat().st_size < MOST_BYTES, f"{path} is too large"


if __name__ == "__main__":
    main()
